"""`ros2 topic echo`."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import yaml

from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.arguments import CSV, STRATEGY
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.message_format import FORMAT, MessageFormat
from tutor.bundled_ros.ros2.names import TOPICS, full_name
from tutor.bundled_ros.ros2.parsing import Verb, argument, flag, positive_float
from tutor.bundled_ros.ros2.qos import overrides_qos, qos_arguments, qos_from_arguments
from tutor.bundled_ros.ros2.receiving import receive
from tutor.bundled_ros.ros2.topic.expressions import compile_filter
from tutor.bundled_ros.ros2.topic.types import message_class, named_class, warn_not_published
from tutor.errors import CommandError
from tutor.ros.batches import DEPTH, Received
from tutor.ros.messages import is_message
from tutor.ros_model import echo_qos

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

_BATCH_PERIOD_S = 0.02


def _echo(arguments: argparse.Namespace) -> None:
    """Print the messages until Ctrl+C. Raises CommandError."""
    format_one = _make_formatter(arguments)
    with join_domain(arguments) as domain:
        if arguments.message_type is None:
            message_type = message_class(domain, arguments.topic_name)
        else:
            message_type = named_class(arguments.message_type)
        if message_type is None:
            warn_not_published(arguments.topic_name)
            raise CommandError("Could not determine the type for the passed topic")
        full_name(domain, arguments.topic_name)  # raises for an invalid topic name
        batches = receive(
            domain,
            arguments.topic_name,
            message_type,
            _qos(domain, arguments),
            raw=arguments.raw,
            gather_s=_BATCH_PERIOD_S,
            on_lost=None if arguments.no_lost_messages else _print_lost,
        )
        _print_all(batches, format_one, arguments)


def _print_all(
    batches: Iterable[list[Received]], format_one: Callable[[Received], str | None], arguments: argparse.Namespace
) -> None:
    deadline = None if arguments.timeout is None else time.monotonic() + arguments.timeout
    for batch in batches:
        texts = [text for received in batch if (text := format_one(received)) is not None]
        if arguments.once and texts:
            sys.stdout.write(texts[0])
            return
        if texts:
            sys.stdout.write("".join(texts))  # one write per batch
            sys.stdout.flush()
        if deadline is not None and time.monotonic() >= deadline:
            return


def _make_formatter(arguments: argparse.Namespace) -> Callable[[Received], str | None]:
    """Return a function that formats a message, or returns None if it is filtered out. Raises CommandError."""
    path = None if arguments.field is None else [step for step in arguments.field.split(".") if step]
    if path == []:
        raise CommandError(f"Invalid field value '{arguments.field}'")
    matches = compile_filter(arguments.filter_expr)
    message_format = MessageFormat.of(arguments)

    def format_received(one: Received) -> str | None:
        message, info = one
        for step in path or ():
            try:
                message = getattr(message, step)
            except AttributeError as error:
                raise CommandError(f"Invalid field '{'.'.join(path or ())}': {error}") from error
        if matches is not None and not matches(message):
            return None
        with_info = arguments.include_message_info
        if not is_message(message):
            head = f"---Got new message, message info:---\n{info}\n---Message data:---\n" if with_info else ""
            return f"{head}{message}\n---\n"
        if arguments.csv:
            head = "".join(f"{value}," for value in info.values()) if with_info else ""
            return f"{head}{message_format.csv(message)}\n"
        head = f"{yaml.dump(info)}---\n" if with_info else ""
        return f"{head}{message_format.yaml(message)}---\n"

    return format_received


def _qos(domain: Domain, arguments: argparse.Namespace) -> QoSProfile:
    """Return the QoS that the options ask for, or else one that all publishers offer."""
    from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

    from tutor.ros.qos import from_rclpy

    profile = qos_from_arguments(arguments)
    if not overrides_qos(arguments):
        publishers = domain.discover_publishers(arguments.topic_name)  # all of them, as the last one may offer less
        if offered := [from_rclpy(info.qos_profile) for info in publishers]:
            chosen = echo_qos(offered)
            profile.reliability = ReliabilityPolicy.get_from_short_key(chosen.reliability)
            profile.durability = DurabilityPolicy.get_from_short_key(chosen.durability)
            if chosen.reliability == "best_effort" and any(qos.reliability == "reliable" for qos in offered):
                _print_fallback("QoSReliabilityPolicy.RELIABLE", "QoSReliabilityPolicy.BEST_EFFORT")
            if chosen.durability == "volatile" and any(qos.durability == "transient_local" for qos in offered):
                _print_fallback("QoSDurabilityPolicy.TRANSIENT_LOCAL", "QoSDurabilityPolicy.VOLATILE")
    if arguments.qos_depth is None and profile.durability != DurabilityPolicy.TRANSIENT_LOCAL:
        profile.depth = DEPTH  # so that a burst is not lost
    return profile


def _print_fallback(stricter: str, fallback: str) -> None:
    print(
        f"Some, but not all, publishers are offering {stricter}. "
        f"Falling back to {fallback} as it will connect to all publishers"
    )


def _print_lost(status: Any) -> None:
    print(
        f"A message was lost!!!\n\ttotal count change:{status.total_count_change}\n\ttotal count: {status.total_count}",
        end="---\n",
    )


GRAMMAR = {
    "echo": Verb(
        _echo,
        *STRATEGY,
        TOPICS.argument(),
        argument(
            "message_type",
            nargs="?",
            complete=completion.types_of_kind("msg"),
            help="its type, such as std_msgs/msg/String (else found out)",
        ),
        *qos_arguments("sensor_data"),
        CSV,
        argument("--field", help="only this field, such as pose.position"),
        *FORMAT,
        flag("--no-lost-messages", help="do not report lost messages"),
        flag("--raw", help="the bytes as they were sent"),
        argument("--filter", dest="filter_expr", help="only messages m for which this Python expression is true"),
        flag("--once", help="end after the first message"),
        argument("--timeout", metavar="N", type=positive_float, help="end after this many seconds"),
        flag("--include-message-info", "-i", help="also timestamps and number of each message"),
    )
}
