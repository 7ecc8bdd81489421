"""`ros2 service type`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import join_domain
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.service.names import service_names, services


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """SERVICE."""
    complete_with(parser.add_argument("service_name", help="the service, such as /add"), service_names)


def main(arguments: argparse.Namespace) -> int:
    """Print the service's types. Return 1 if there is no such service."""
    hidden = arguments.include_hidden_services
    with join_domain(arguments) as domain:
        types = domain.find(lambda: dict(services(domain, hidden=hidden)).get(arguments.service_name))
    for type_name in types or ():
        print(type_name)
    return 0 if types else 1
