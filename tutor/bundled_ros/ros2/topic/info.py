"""`ros2 topic info`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import Domain, add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.topic.names import topic_names, topics
from tutor.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-v] TOPIC."""
    add_strategy_arguments(parser)
    complete_with(parser.add_argument("topic_name", help="the topic, such as /chatter"), topic_names)
    parser.add_argument("--verbose", "-v", action="store_true", help="each endpoint's node, type hash, id and QoS")


def main(arguments: argparse.Namespace) -> None:
    """Print the topic's type and endpoints. Raises CommandError if no topic has exactly this name."""
    with join_domain(arguments) as domain:
        types = domain.find(lambda: dict(topics(domain, hidden=True)).get(arguments.topic_name))
        if types is None:
            raise CommandError(f"Unknown topic '{arguments.topic_name}'")
        domain.wait_for_discovery()
        _print(domain, arguments.topic_name, types[0] if len(types) == 1 else types, arguments.verbose)


def _print(domain: Domain, topic: str, types: object, verbose: bool) -> None:
    node, end = domain.node, "\n\n" if verbose else "\n"
    print(f"Type: {types}", end=end)
    print(f"Publisher count: {node.count_publishers(topic)}", end=end)
    for info in node.get_publishers_info_by_topic(topic) if verbose else ():
        print(info, end=end)
    print(f"Subscription count: {node.count_subscribers(topic)}", end=end)
    for info in node.get_subscriptions_info_by_topic(topic) if verbose else ():
        print(info, end=end)
