"""`ros2 topic list`."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence

from tutor.bundled_ros.ros2.domain import add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.topic.names import topics


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-t] [-c] [--include-hidden-topics] [-v]."""
    add_strategy_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="the types as well")
    parser.add_argument("-c", "--count-topics", action="store_true", help="only how many topics there are")
    parser.add_argument(
        "--include-hidden-topics", action="store_true", default=argparse.SUPPRESS, help="hidden topics as well"
    )
    parser.add_argument("-v", "--verbose", action="store_true", help="also how many publish and subscribe to each")


def main(arguments: argparse.Namespace) -> None:
    """Print the topics."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = topics(domain, hidden=arguments.include_hidden_topics)
        publishers = {name: domain.node.count_publishers(name) for name, _ in found}
        subscribers = {name: domain.node.count_subscribers(name) for name, _ in found}
    if arguments.count_topics:
        print(len(found))
    elif arguments.verbose:
        _print_counts("Published", "publisher", found, publishers)
        _print_counts("Subscribed", "subscriber", found, subscribers)
    else:
        for name, types in found:
            print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)


def _print_counts(title: str, who: str, found: Iterable[tuple[str, Sequence[str]]], counts: dict[str, int]) -> None:
    print(f"{title} topics:")
    for name, types in found:
        if count := counts[name]:
            print(f" * {name} [{', '.join(types)}] {count} {who}{'s' if count > 1 else ''}")
    print()
