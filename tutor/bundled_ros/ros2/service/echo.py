"""`ros2 service echo`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.calling import SPIN_TIMEOUT_S, make_executor
from tutor.bundled_ros.ros2.domain import join_domain
from tutor.bundled_ros.ros2.message_format import MessageFormat, add_format_arguments
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.service.names import service_names, service_types, services
from tutor.errors import CommandError, UnknownType
from tutor.ros.interfaces import find_interface

EVENTS = ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")
"""The names of service_msgs/msg/ServiceEventInfo's event types, by number."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """SERVICE [TYPE] and the format options."""
    complete_with(parser.add_argument("service_name", help="the service, such as /add"), service_names)
    complete_with(parser.add_argument("service_type", nargs="?", help="its type, if nobody offers it"), service_types)
    parser.add_argument("--csv", action="store_true", help="all values, separated by commas")
    add_format_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print each event of the service. Raises CommandError if its type is unknown."""
    from rclpy.qos import QoSPresetProfiles

    name, message_format = arguments.service_name, MessageFormat.of(arguments)
    with join_domain(arguments) as domain:
        type_name = arguments.service_type
        if type_name is None:
            types = domain.find(lambda: dict(services(domain, hidden=True)).get(name))
            if not types:
                raise CommandError(f"Cannot find type for '{name}'")
            if len(types) > 1:
                raise CommandError(f"More than one type associated with service '{name}'")
            type_name = types[0]
        try:
            event_class = find_interface(type_name, "srv").Event
        except UnknownType as error:
            raise CommandError(f"The service type '{type_name}' is invalid") from error

        def on_event(event: object) -> None:
            if arguments.csv:
                print(message_format.csv(event), flush=True)
                return
            number = event.info.event_type  # type: ignore[attr-defined]
            text = message_format.yaml(event).replace(f"event_type: {number}", f"event_type: {EVENTS[number]}", 1)
            print(f"{text.rstrip()}\n---", flush=True)

        topic = f"{name}/_service_event"
        qos = QoSPresetProfiles.get_from_short_key("services_default")
        subscription = domain.node.create_subscription(event_class, topic, on_event, qos)
        domain.find(lambda: subscription.get_publisher_count() or None)
        if not subscription.get_publisher_count():
            print(f"No publishers on topic '{topic}'; is service introspection on the client or server enabled?")
        executor = make_executor(domain.node)
        while True:
            executor.spin_once(timeout_sec=SPIN_TIMEOUT_S)
