"""`ros2 topic type`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.topic.names import topic_names, topics


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TOPIC."""
    add_strategy_arguments(parser)
    complete_with(parser.add_argument("topic_name", help="the topic, such as /chatter"), topic_names)


def main(arguments: argparse.Namespace) -> int:
    """Print the topic's types. Return 1 if there is no such topic."""
    with join_domain(arguments) as domain:
        types = domain.find(
            lambda: dict(topics(domain, hidden=arguments.include_hidden_topics)).get(arguments.topic_name)
        )
    for type_name in types or ():
        print(type_name)
    return 0 if types else 1
