"""`ros2 service echo`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.arguments import CSV
from tutor.bundled_ros.ros2.calling import SPIN_TIMEOUT_S, make_executor
from tutor.bundled_ros.ros2.domain import join_domain
from tutor.bundled_ros.ros2.message_format import FORMAT, MessageFormat
from tutor.bundled_ros.ros2.names import SERVICES, class_of_type
from tutor.bundled_ros.ros2.parsing import Verb, argument
from tutor.errors import CommandError

EVENTS = ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")
"""The names of service_msgs/msg/ServiceEventInfo's event types, by number."""


def _echo(arguments: argparse.Namespace) -> None:
    """Print each event of the service. Raises CommandError if its type is unknown."""
    from rclpy.qos import QoSPresetProfiles

    name, message_format = arguments.service_name, MessageFormat.of(arguments)
    with join_domain(arguments) as domain:
        type_name = arguments.service_type
        if type_name is None:
            types = SERVICES.types_of(domain, name)
            if not types:
                raise CommandError(f"Cannot find type for '{name}'")
            if len(types) > 1:
                raise CommandError(f"More than one type associated with service '{name}'")
            type_name = types[0]
        event_class = class_of_type(type_name, "srv", f"The service type '{type_name}' is invalid").Event

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


GRAMMAR = {
    "echo": Verb(
        _echo,
        SERVICES.argument(),
        argument("service_type", nargs="?", complete=SERVICES.complete_types, help="its type, if nobody offers it"),
        CSV,
        *FORMAT,
    )
}
