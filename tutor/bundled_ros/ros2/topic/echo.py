"""`ros2 topic echo`."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import yaml

from tutor.bundled_ros.ros2.domain import Domain, add_strategy_arguments, join_domain
from tutor.bundled_ros.ros2.interfaces import UnknownInterface, find_interface, message_names
from tutor.bundled_ros.ros2.message_format import MessageFormat, add_format_arguments
from tutor.bundled_ros.ros2.parsing import complete_with, positive_float
from tutor.bundled_ros.ros2.qos import add_qos_arguments, asks_for_qos, qos_of
from tutor.bundled_ros.ros2.receiving import DEPTH, Received, receive
from tutor.bundled_ros.ros2.topic.expressions import expression
from tutor.bundled_ros.ros2.topic.names import full_name, message_class, topic_names, warn_of_no_publisher
from tutor.errors import CommandError
from tutor.ros_model import echo_qos

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

_GATHER_S = 0.02


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TOPIC [TYPE], and what is shown of each message."""
    add_strategy_arguments(parser)
    complete_with(parser.add_argument("topic_name", help="the topic, such as /chatter"), topic_names)
    kind = parser.add_argument("message_type", nargs="?", help="its type, such as std_msgs/msg/String (else found out)")
    complete_with(kind, message_names)
    add_qos_arguments(parser, "sensor_data")
    add = parser.add_argument
    add("--csv", action="store_true", help="all values, separated by commas")
    add("--field", help="only this field, such as pose.position")
    add_format_arguments(parser)
    add("--no-lost-messages", action="store_true", help="do not report lost messages")
    add("--raw", action="store_true", help="the bytes as they were sent")
    add("--filter", dest="filter_expr", help="only messages m for which this Python expression is true")
    add("--once", action="store_true", help="end after the first message")
    add("--timeout", metavar="N", type=positive_float, help="end after this many seconds")
    add("--include-message-info", "-i", action="store_true", help="also timestamps and number of each message")


def main(arguments: argparse.Namespace) -> None:
    """Print the messages until Ctrl+C. Raises CommandError."""
    print_one = _printer(arguments)
    with join_domain(arguments) as domain:
        if arguments.message_type is None:
            message_type = message_class(domain, arguments.topic_name)
        else:
            message_type = _named(arguments.message_type)
        if message_type is None:
            warn_of_no_publisher(arguments.topic_name)
            raise CommandError("Could not determine the type for the passed topic")
        full_name(domain, arguments.topic_name)  # reports a name that no topic can have
        batches = receive(
            domain,
            arguments.topic_name,
            message_type,
            _qos(domain, arguments),
            raw=arguments.raw,
            gather_s=_GATHER_S,
            on_lost=None if arguments.no_lost_messages else _tell_lost,
        )
        _print_all(batches, print_one, arguments)


def _named(name: str) -> Any:
    try:
        return find_interface(name, "msg")
    except UnknownInterface:
        raise CommandError("The passed message type is invalid") from None


def _print_all(
    batches: Iterable[list[Received]], print_one: Callable[[Received], str | None], arguments: argparse.Namespace
) -> None:
    ends = None if arguments.timeout is None else time.monotonic() + arguments.timeout
    for batch in batches:
        printed = [text for one in batch if (text := print_one(one)) is not None]
        if arguments.once and printed:
            sys.stdout.write(printed[0])
            return
        if printed:
            sys.stdout.write("".join(printed))  # one write for all of them
            sys.stdout.flush()
        if ends is not None and time.monotonic() >= ends:
            return


def _printer(arguments: argparse.Namespace) -> Callable[[Received], str | None]:
    """Gives what is printed of a message; None where it is filtered out. Raises CommandError."""
    path = None if arguments.field is None else [step for step in arguments.field.split(".") if step]
    if path == []:
        raise CommandError(f"Invalid field value '{arguments.field}'")
    holds = expression(arguments.filter_expr)
    form = MessageFormat.of(arguments)

    def text_of(one: Received) -> str | None:
        message, info = one
        for step in path or ():
            try:
                message = getattr(message, step)
            except AttributeError as error:
                raise CommandError(f"Invalid field '{'.'.join(path or ())}': {error}") from error
        if holds is not None and not holds(message):
            return None
        with_info = arguments.include_message_info
        if not hasattr(message, "get_fields_and_field_types"):
            head = f"---Got new message, message info:---\n{info}\n---Message data:---\n" if with_info else ""
            return f"{head}{message}\n---\n"
        if arguments.csv:
            head = "".join(f"{value}," for value in info.values()) if with_info else ""
            return f"{head}{form.csv(message)}\n"
        head = f"{yaml.dump(info)}---\n" if with_info else ""
        return f"{head}{form.yaml(message)}---\n"

    return text_of


def _qos(domain: Domain, arguments: argparse.Namespace) -> QoSProfile:
    """What the options ask for, else what all publishers offer."""
    from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

    from tutor.ros.qos import from_rclpy

    profile = qos_of(arguments)
    if not asks_for_qos(arguments):
        publishers = domain.complete_publishers(arguments.topic_name)  # one more may offer less
        if offered := [from_rclpy(info.qos_profile) for info in publishers]:
            chosen = echo_qos(offered)
            profile.reliability = ReliabilityPolicy.get_from_short_key(chosen.reliability)
            profile.durability = DurabilityPolicy.get_from_short_key(chosen.durability)
            if chosen.reliability == "best_effort" and any(each.reliability == "reliable" for each in offered):
                _tell_fallback("QoSReliabilityPolicy.RELIABLE", "QoSReliabilityPolicy.BEST_EFFORT")
            if chosen.durability == "volatile" and any(each.durability == "transient_local" for each in offered):
                _tell_fallback("QoSDurabilityPolicy.TRANSIENT_LOCAL", "QoSDurabilityPolicy.VOLATILE")
    if arguments.qos_depth is None and profile.durability != DurabilityPolicy.TRANSIENT_LOCAL:
        profile.depth = DEPTH  # nothing is lost in a burst
    return profile


def _tell_fallback(best: str, other: str) -> None:
    print(
        f"Some, but not all, publishers are offering {best}. "
        f"Falling back to {other} as it will connect to all publishers"
    )


def _tell_lost(status: Any) -> None:
    print(
        f"A message was lost!!!\n\ttotal count change:{status.total_count_change}\n\ttotal count: {status.total_count}",
        end="---\n",
    )
