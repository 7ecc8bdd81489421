"""`ros2 topic find`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.domain import add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.topic.names import topics


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-c] [--include-hidden-topics] TYPE."""
    add_strategy_arguments(parser)
    complete_with(
        parser.add_argument("topic_type", help="the type, such as std_msgs/msg/String"), completion.types("msg")
    )
    parser.add_argument("-c", "--count-topics", action="store_true", help="only how many topics there are")
    parser.add_argument(
        "--include-hidden-topics", action="store_true", default=argparse.SUPPRESS, help="hidden topics as well"
    )


def main(arguments: argparse.Namespace) -> None:
    """Print the topics of exactly this type."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = topics(domain, hidden=arguments.include_hidden_topics)
    names = [name for name, types in found if arguments.topic_type in types]
    print(len(names)) if arguments.count_topics else print(*names, sep="\n", end="\n" if names else "")
