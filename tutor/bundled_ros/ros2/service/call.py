"""`ros2 service call`."""

from __future__ import annotations

import argparse
import sys
import time

from tutor.bundled_ros.ros2.arguments import yaml_or_stdin
from tutor.bundled_ros.ros2.calling import wait_for_answer, wait_until
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import SERVICES
from tutor.bundled_ros.ros2.parsing import Verb, argument
from tutor.bundled_ros.ros2.yaml_input import message_from_yaml
from tutor.errors import CommandError, UnknownType
from tutor.ros.interfaces import WrongKind, find_interface


def _call(arguments: argparse.Namespace) -> None:
    """Call the service and print the request and the response. Raises CommandError for a wrong type or value."""
    if arguments.rate is not None and arguments.rate <= 0:
        raise CommandError("rate must be greater than zero")
    try:
        service_class = find_interface(arguments.service_type, "srv")
    except WrongKind as error:
        raise CommandError("The passed type is not a service") from error
    except UnknownType as error:
        raise CommandError("The passed service type is invalid") from error
    text = sys.stdin.read() if arguments.stdin else arguments.values
    request = message_from_yaml(service_class.Request, text, failed="Failed to populate field: {}")
    with join_domain(arguments) as domain:
        client = domain.node.create_client(service_class, arguments.service_name)
        print("waiting for service to become available...")
        wait_until(client.service_is_ready, notice=lambda: _explain_unavailable(domain, arguments))
        while True:
            called_at = time.monotonic()
            print(f"requester: making request: {request!r}\n")
            answer = wait_for_answer(
                domain, client.call_async(request), notice=lambda: f"no answer from {arguments.service_name} yet"
            )
            print(f"response:\n{answer!r}\n")
            if arguments.rate is None:
                return
            time.sleep(max(0.0, called_at + 1 / arguments.rate - time.monotonic()))


def _explain_unavailable(domain: Domain, arguments: argparse.Namespace) -> str:
    """Explain, from the graph, why the service is not available."""
    name = arguments.service_name if arguments.service_name.startswith("/") else f"/{arguments.service_name}"
    package, *_, last = arguments.service_type.split("/")
    types = dict(SERVICES.known(domain, hidden=True)).get(name, ())
    others = [other for other in types if other != f"{package}/srv/{last}"]
    if others and domain.node.count_services(name):  # our own client alone already lists the service
        return f"{name} is there, but its type is {', '.join(others)}"
    return f"no node offers {name} yet; Ctrl+C ends the wait"


GRAMMAR = {
    "call": Verb(
        _call,
        SERVICES.argument(),
        argument("service_type", complete=SERVICES.complete_types, help="its type, such as std_srvs/srv/Trigger"),
        yaml_or_stdin(
            "values", "the request as YAML, such as '{a: 1, b: 2}'", stdin_help="read the request from standard input"
        ),
        argument("-r", "--rate", metavar="N", type=float, help="call again and again, N times a second"),
    )
}
