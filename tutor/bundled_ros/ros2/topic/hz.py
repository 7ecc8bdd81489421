"""`ros2 topic hz`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import add_direct_arguments, join_domain
from tutor.bundled_ros.ros2.topic.expressions import compile_filter
from tutor.bundled_ros.ros2.topic.measuring import add_topic, add_window, arrival_clock, receive_measured
from tutor.bundled_ros.ros2.topic.names import wait_for_class
from tutor.bundled_ros.ros2.topic.statistics import Rate


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TOPIC [-w N] [--filter EXPR] [--wall-time]."""
    add_topic(parser, "topic_name")
    add_window(parser, 10_000, "window_size")
    parser.add_argument(
        "--filter", dest="filter_expr", metavar="EXPR", help="only messages m for which this Python expression is true"
    )
    parser.add_argument(
        "--wall-time", dest="use_wtime", action="store_true", help="this machine's time, also with --use-sim-time"
    )
    add_direct_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the rate once a second until Ctrl+C. Raises CommandError."""
    matches = compile_filter(arguments.filter_expr)
    with join_domain(arguments) as domain:
        message_type = wait_for_class(domain, arguments.topic_name)
        rate = Rate(arguments.window_size)
        time_of = arrival_clock(domain, simulated=arguments.use_sim_time and not arguments.use_wtime)
        for batch in receive_measured(domain, arguments.topic_name, message_type, raw=matches is None):
            for one in batch:
                if (matches is None or matches(one[0])) and (text := rate.add(time_of(one))) is not None:
                    print(text)
