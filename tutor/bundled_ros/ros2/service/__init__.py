"""`ros2 service`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.arguments import SHOW_TYPES, STRATEGY, count, hidden
from tutor.bundled_ros.ros2.domain import join_domain
from tutor.bundled_ros.ros2.names import SERVICES
from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs, argument
from tutor.errors import CommandError


def _info(arguments: argparse.Namespace) -> None:
    """Print the type and the number of clients and servers. Raises CommandError if no service has exactly this name."""
    name = arguments.service_name
    with join_domain(arguments) as domain:
        domain.wait_for_discovery()
        types = dict(SERVICES.known(domain, hidden=arguments.hidden)).get(name)
        if types is None:
            raise CommandError(f"Unknown service '{name}'")
        print(f"Type: {types[0] if len(types) == 1 else list(types)}")
        print(f"Clients count: {domain.node.count_clients(name)}")
        print(f"Services count: {domain.node.count_services(name)}")


_TYPE = argument("service_type", complete=SERVICES.complete_types, help="the type, such as std_srvs/srv/Trigger")
_VERBS: Verbs = {
    "call": ("Call a service and show its answer", "service.call"),
    "echo": ("Show the calls of a service, where it publishes them", "service.echo"),
    "find": (
        "List the services of a type",
        Verb(SERVICES.list_of_type, _TYPE, count("services"), hidden("services")),
    ),
    "info": (
        "Show a service's type, and how many offer and call it",
        Verb(_info, *STRATEGY, SERVICES.argument()),
    ),
    "list": (
        "List the services",
        Verb(SERVICES.list_all, *STRATEGY, SHOW_TYPES, count("services"), hidden("services")),
    ),
    "type": ("Show a service's type", Verb(SERVICES.list_types, SERVICES.argument())),
}
GRAMMAR = {"service": Group(_VERBS, hidden("services", of_verb=False))}
