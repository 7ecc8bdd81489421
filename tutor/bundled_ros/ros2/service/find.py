"""`ros2 service find`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import join_domain
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.service.names import add_hidden_option, service_types, services


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-c] [--include-hidden-services] TYPE."""
    complete_with(parser.add_argument("service_type", help="the type, such as std_srvs/srv/Trigger"), service_types)
    parser.add_argument("-c", "--count-services", action="store_true", help="only how many services there are")
    add_hidden_option(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the services of exactly this type."""
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        found = services(domain, hidden=arguments.include_hidden_services)
    names = [name for name, types in found if arguments.service_type in types]
    if arguments.count_services:
        print(len(names))
        return
    for name in names:
        print(name)
