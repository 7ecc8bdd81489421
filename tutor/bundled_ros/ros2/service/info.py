"""`ros2 service info`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.service.names import service_names, services
from tutor.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """SERVICE."""
    add_strategy_arguments(parser)
    complete_with(parser.add_argument("service_name", help="the service, such as /add"), service_names)


def main(arguments: argparse.Namespace) -> None:
    """Print the type and the number of clients and servers. Raises CommandError if no service has exactly this name."""
    name = arguments.service_name
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        types = dict(services(domain, hidden=arguments.include_hidden_services)).get(name)
        if types is None:
            raise CommandError(f"Unknown service '{name}'")
        print(f"Type: {types[0] if len(types) == 1 else list(types)}")
        print(f"Clients count: {domain.node.count_clients(name)}")
        print(f"Services count: {domain.node.count_services(name)}")
