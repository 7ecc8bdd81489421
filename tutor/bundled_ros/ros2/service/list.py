"""`ros2 service list`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.service.names import add_hidden_option, services


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-t] [-c] [--include-hidden-services]."""
    add_strategy_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="the types as well")
    parser.add_argument("-c", "--count-services", action="store_true", help="only how many services there are")
    add_hidden_option(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the services."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = services(domain, hidden=arguments.include_hidden_services)
    if arguments.count_services:
        print(len(found))
        return
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)
