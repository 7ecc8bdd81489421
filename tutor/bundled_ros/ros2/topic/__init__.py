"""`ros2 topic`."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence

from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.arguments import SHOW_TYPES, STRATEGY, count, hidden
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import TOPICS
from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs, argument, flag
from tutor.errors import CommandError


def _list(arguments: argparse.Namespace) -> None:
    """Print the topics."""
    if arguments.count or not arguments.verbose:
        TOPICS.list_all(arguments)
        return
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = TOPICS.known(domain, hidden=arguments.hidden)
        publishers = {name: domain.node.count_publishers(name) for name, _ in found}
        subscribers = {name: domain.node.count_subscribers(name) for name, _ in found}
    _print_counts("Published", "publisher", found, publishers)
    _print_counts("Subscribed", "subscriber", found, subscribers)


def _print_counts(title: str, who: str, found: Iterable[tuple[str, Sequence[str]]], counts: dict[str, int]) -> None:
    print(f"{title} topics:")
    for name, types in found:
        if number := counts[name]:
            print(f" * {name} [{', '.join(types)}] {number} {who}{'s' if number > 1 else ''}")
    print()


def _info(arguments: argparse.Namespace) -> None:
    """Print the topic's type and endpoints. Raises CommandError if no topic has exactly this name."""
    with join_domain(arguments) as domain:
        types = TOPICS.types_of(domain, arguments.topic_name)
        if types is None:
            raise CommandError(f"Unknown topic '{arguments.topic_name}'")
        domain.wait_for_discovery()
        _print_info(domain, arguments.topic_name, types[0] if len(types) == 1 else types, arguments.verbose)


def _print_info(domain: Domain, topic: str, types: object, verbose: bool) -> None:
    node, end = domain.node, "\n\n" if verbose else "\n"
    print(f"Type: {types}", end=end)
    print(f"Publisher count: {node.count_publishers(topic)}", end=end)
    for info in node.get_publishers_info_by_topic(topic) if verbose else ():
        print(info, end=end)
    print(f"Subscription count: {node.count_subscribers(topic)}", end=end)
    for info in node.get_subscriptions_info_by_topic(topic) if verbose else ():
        print(info, end=end)


_VERBS: Verbs = {
    "bw": ("Measure how many bytes a second a topic carries", "topic.measuring"),
    "delay": ("Measure how old a topic's messages are when they arrive, by their header", "topic.measuring"),
    "echo": ("Print the messages on a topic", "topic.echo"),
    "find": (
        "List the topics of a type",
        Verb(
            TOPICS.list_of_type,
            *STRATEGY,
            argument(
                "topic_type", complete=completion.types_of_kind("msg"), help="the type, such as std_msgs/msg/String"
            ),
            count("topics"),
            hidden("topics"),
        ),
    ),
    "hz": ("Measure a topic's rate", "topic.measuring"),
    "info": (
        "Show a topic's type, and how many publish and subscribe to it",
        Verb(
            _info,
            *STRATEGY,
            TOPICS.argument(),
            flag("--verbose", "-v", help="each endpoint's node, type hash, id and QoS"),
        ),
    ),
    "list": (
        "List the topics",
        Verb(
            _list,
            *STRATEGY,
            SHOW_TYPES,
            count("topics"),
            hidden("topics"),
            flag("-v", "--verbose", help="also how many publish and subscribe to each"),
        ),
    ),
    "pub": ("Publish messages on a topic", "topic.pub"),
    "type": ("Show a topic's type", Verb(TOPICS.list_types, *STRATEGY, TOPICS.argument())),
}
GRAMMAR = {"topic": Group(_VERBS, hidden("topics", of_verb=False))}
