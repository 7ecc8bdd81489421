"""`ros2 topic pub`."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import yaml

from tutor.bundled_ros.ros2.arguments import DIRECT, yaml_or_stdin
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import TOPICS, full_name
from tutor.bundled_ros.ros2.parsing import OneOf, Verb, argument, flag, nonnegative_int, positive_float
from tutor.bundled_ros.ros2.qos import qos_arguments, qos_from_arguments
from tutor.bundled_ros.ros2.topic.types import named_class
from tutor.errors import CommandError
from tutor.ros.fields import SetStamp, set_fields
from tutor.ros.interfaces import find_interface
from tutor.ros.yaml_format import to_yaml

if TYPE_CHECKING:
    from rclpy.publisher import Publisher

_POLL_S = 0.02
_MATCHING_GRACE_S = 0.5
"""How long matching takes at most between endpoints that exist; no message about the wait is printed before."""

_ACK_TIMEOUT_S = 1.0


def _pub(arguments: argparse.Namespace) -> None:
    """Publish the message. Raises CommandError."""
    times = 1 if arguments.once else arguments.times
    required = arguments.wait_matching_subscriptions
    required = int(times != 0) if required is None else required
    text = sys.stdin.read() if arguments.stdin else arguments.values
    message_type = named_class(arguments.message_type)
    values = _parse_values(text)
    if required == 0 and arguments.max_wait_time_secs is not None:
        raise CommandError(
            "--max-wait-time-secs option is only effective with --wait-matching-subscriptions, --once or --times"
        )
    with join_domain(arguments, name=arguments.node_name) as domain:
        full_name(domain, arguments.topic_name)  # raises for an invalid topic name
        if required:
            domain.wait_for_discovery()
        publisher = domain.node.create_publisher(message_type, arguments.topic_name, qos_from_arguments(arguments))
        _wait_for_subscriptions(domain, publisher, required, arguments.max_wait_time_secs)
        message = message_type()
        stamps: list[SetStamp] = []
        try:
            set_fields(message, values, stamps)
        except Exception as error:  # whatever the field's type raises for the user's value
            raise CommandError(f"Failed to populate field: {error}") from error
        print("publisher: beginning loop")

        def publish() -> None:
            now = domain.node.get_clock().now().to_msg()
            for set_stamp in stamps:
                set_stamp(now)
            publisher.publish(message)

        _publish_all(publish, message, times, 1.0 / arguments.rate, arguments.print)
        time.sleep(arguments.keep_alive)
        _wait_for_acknowledgement(publisher)


def _parse_values(text: str) -> dict[str, Any]:
    try:
        # bash shows the newlines of a completed message as ^J
        values = yaml.safe_load(text.replace("^J", "\n"))
    except yaml.YAMLError:
        raise CommandError("The passed value needs to be in YAML string or a dictionary") from None
    if not isinstance(values, dict):
        raise CommandError("The passed value needs to be a dictionary in YAML format")
    return values


def _wait_for_subscriptions(domain: Domain, publisher: Publisher, required: int, limit_s: float | None) -> None:
    started = print_at = time.monotonic()
    if domain.node.count_subscribers(publisher.topic_name) >= required:
        print_at += _MATCHING_GRACE_S  # the subscriptions exist, and matching takes a moment
    while (matched := publisher.get_subscription_count()) < required:
        now = time.monotonic()
        if now >= print_at:
            print_at += 1.0
            print(f"Waiting for at least {required} matching subscription(s)...")
        if limit_s is not None and now - started >= limit_s:
            # "subcribers" is ros2cli's own spelling, which scripts may match.
            raise CommandError(
                f"Timed out waiting for subscribers: Expected {required} subcribers but only got {matched} subscribers"
            )
        time.sleep(_POLL_S)


def _publish_all(publish: Callable[[], None], message: Any, times: int, period_s: float, print_every: int) -> None:
    count, due = 0, time.monotonic()
    while True:
        count += 1
        publish()
        if print_every and count % print_every == 0:
            sys.stdout.write(f"publishing #{count}: {message!r}\n\n")  # one write: Ctrl+C cannot cut it in half
        if count == times:
            return
        due = max(due + period_s, time.monotonic() - period_s)  # catch up on one late message, not on many
        time.sleep(max(0.0, due - time.monotonic()))


def _wait_for_acknowledgement(publisher: Publisher) -> None:
    from rclpy.duration import Duration

    publisher.wait_for_all_acked(Duration(seconds=_ACK_TIMEOUT_S))


def _complete_values(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete the message with its default values."""
    return [to_yaml(find_interface(parsed_args.message_type, "msg")())]


GRAMMAR = {
    "pub": Verb(
        _pub,
        TOPICS.argument(),
        argument("message_type", complete=TOPICS.complete_types, help="its type, such as std_msgs/msg/String"),
        yaml_or_stdin(
            "values",
            "the message in YAML, such as 'data: hello' (else its defaults)",
            stdin_help="read the message from stdin",
            complete=_complete_values,
        ),
        argument(
            "-r", "--rate", metavar="N", type=positive_float, default=1.0, help="messages per second (default: 1)"
        ),
        argument("-p", "--print", metavar="N", type=int, default=1, help="print every N-th message only (default: 1)"),
        OneOf(
            flag("-1", "--once", help="publish one message"),
            argument("-t", "--times", type=nonnegative_int, default=0, help="publish this many messages"),
        ),
        argument(
            "-w",
            "--wait-matching-subscriptions",
            type=nonnegative_int,
            help="wait for this many subscriptions (default: 1 with --once and --times, else 0)",
        ),
        argument("--max-wait-time-secs", type=positive_float, help="the longest such wait (default: forever)"),
        argument(
            "--keep-alive",
            metavar="N",
            type=positive_float,
            default=0.1,
            help="stay for N seconds after the last message (default: 0.1)",
        ),
        argument("-n", "--node-name", help="the publishing node's name"),
        *qos_arguments("default"),
        *DIRECT,
    )
}
