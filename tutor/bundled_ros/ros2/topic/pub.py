"""`ros2 topic pub`."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import yaml

from tutor.bundled_ros.ros2.domain import Domain, add_direct_arguments, join_domain
from tutor.bundled_ros.ros2.interfaces import UnknownInterface, find_interface, message_names
from tutor.bundled_ros.ros2.message_values import set_fields
from tutor.bundled_ros.ros2.parsing import complete_with, nonnegative_int, positive_float
from tutor.bundled_ros.ros2.qos import add_qos_arguments, qos_of
from tutor.bundled_ros.ros2.topic.names import full_name, topic_names, topics
from tutor.errors import CommandError
from tutor.ros.yaml_format import to_yaml

if TYPE_CHECKING:
    from rclpy.publisher import Publisher

_LOOK_S = 0.02
_MATCHING_S = 0.5
_ACKNOWLEDGED_S = 1.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TOPIC TYPE [VALUES], and how often."""
    complete_with(parser.add_argument("topic_name", help="the topic, such as /chatter"), topic_names)
    complete_with(parser.add_argument("message_type", help="its type, such as std_msgs/msg/String"), _types)
    source = parser.add_mutually_exclusive_group()
    values = source.add_argument(
        "values", nargs="?", default="{}", help="the message in YAML, such as 'data: hello' (else its defaults)"
    )
    complete_with(values, _prototype)
    source.add_argument("--stdin", action="store_true", help="read the message from stdin")
    add = parser.add_argument
    add("-r", "--rate", metavar="N", type=positive_float, default=1.0, help="messages per second (default: 1)")
    add("-p", "--print", metavar="N", type=int, default=1, help="print every N-th message only (default: 1)")
    many = parser.add_mutually_exclusive_group()
    many.add_argument("-1", "--once", action="store_true", help="publish one message")
    many.add_argument("-t", "--times", type=nonnegative_int, default=0, help="publish this many messages")
    add(
        "-w",
        "--wait-matching-subscriptions",
        type=nonnegative_int,
        help="wait for this many subscriptions (default: 1 with --once and --times, else 0)",
    )
    add("--max-wait-time-secs", type=positive_float, help="the longest such wait (default: forever)")
    add(
        "--keep-alive",
        metavar="N",
        type=positive_float,
        default=0.1,
        help="stay for N seconds after the last message (default: 0.1)",
    )
    add("-n", "--node-name", help="the publishing node's name")
    add_qos_arguments(parser, "default")
    add_direct_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Publish. Raises CommandError."""
    times = 1 if arguments.once else arguments.times
    least = arguments.wait_matching_subscriptions
    least = int(times != 0) if least is None else least
    text = sys.stdin.read() if arguments.stdin else arguments.values
    message_type = _named(arguments.message_type)
    values = _read(text)
    if least == 0 and arguments.max_wait_time_secs is not None:
        raise CommandError(
            "--max-wait-time-secs option is only effective with --wait-matching-subscriptions, --once or --times"
        )
    with join_domain(arguments, name=arguments.node_name) as domain:
        full_name(domain, arguments.topic_name)  # reports a name that no topic can have
        if least:
            domain.complete()
        publisher = domain.node.create_publisher(message_type, arguments.topic_name, qos_of(arguments))
        _await_subscriptions(domain, publisher, least, arguments.max_wait_time_secs)
        message = message_type()
        try:
            stamps = set_fields(message, values, stamps=True)
        except Exception as error:  # whatever a field's type makes of the user's value
            raise CommandError(f"Failed to populate field: {error}") from error
        print("publisher: beginning loop")

        def publish() -> None:
            now = domain.node.get_clock().now().to_msg()
            for set_stamp in stamps:
                set_stamp(now)
            publisher.publish(message)

        _publish_all(publish, message, times, 1.0 / arguments.rate, arguments.print)
        time.sleep(arguments.keep_alive)
        _await_acknowledgement(publisher)


def _named(name: str) -> Any:
    try:
        return find_interface(name, "msg")
    except UnknownInterface:
        raise CommandError("The passed message type is invalid") from None


def _read(text: str) -> dict[str, Any]:
    try:
        # bash puts ^J where a completed message has a line's end
        values = yaml.safe_load(text.replace("^J", "\n"))
    except yaml.YAMLError:
        raise CommandError("The passed value needs to be in YAML string or a dictionary") from None
    if not isinstance(values, dict):
        raise CommandError("The passed value needs to be a dictionary in YAML format")
    return values


def _await_subscriptions(domain: Domain, publisher: Publisher, least: int, limit_s: float | None) -> None:
    start = say_at = time.monotonic()
    if domain.node.count_subscribers(publisher.topic_name) >= least:
        say_at += _MATCHING_S  # they are there, and it takes them a moment to know each other
    while (there := publisher.get_subscription_count()) < least:
        now = time.monotonic()
        if now >= say_at:
            say_at += 1.0
            print(f"Waiting for at least {least} matching subscription(s)...")
        if limit_s is not None and now - start >= limit_s:
            # The word that is misspelt is what scripts look for.
            raise CommandError(
                f"Timed out waiting for subscribers: Expected {least} subcribers but only got {there} subscribers"
            )
        time.sleep(_LOOK_S)


def _publish_all(publish: Callable[[], None], message: Any, times: int, period_s: float, print_every: int) -> None:
    count, due = 0, time.monotonic()
    while True:
        count += 1
        publish()
        if print_every and count % print_every == 0:
            sys.stdout.write(f"publishing #{count}: {message!r}\n\n")  # in one go: Ctrl+C leaves no half of it
        if count == times:
            return
        due = max(due + period_s, time.monotonic() - period_s)  # a late one is followed at once, many are not made up
        time.sleep(max(0.0, due - time.monotonic()))


def _await_acknowledgement(publisher: Publisher) -> None:
    from rclpy.duration import Duration

    publisher.wait_for_all_acked(Duration(seconds=_ACKNOWLEDGED_S))


def _types(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """For Tab: the topic's type where it is there, else all."""
    with join_domain(parsed_args) as domain:
        found = domain.find(lambda: dict(topics(domain, hidden=True)).get(parsed_args.topic_name))
    return list(found) if found else message_names()


def _prototype(prefix: str, parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """For Tab: the message with its defaults."""
    return [to_yaml(find_interface(parsed_args.message_type, "msg")())]
