"""`ros2 topic delay`."""

from __future__ import annotations

import argparse
import time
from collections import deque
from typing import Any

from tutor.bundled_ros.ros2.domain import add_direct_arguments, join_domain
from tutor.bundled_ros.ros2.topic.measuring import add_topic, add_window, arrival, receive_measured
from tutor.bundled_ros.ros2.topic.names import wait_for_class
from tutor.bundled_ros.ros2.topic.statistics import spread
from tutor.errors import CommandError

_PRINT_EVERY_S = 1.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TOPIC [-w N]."""
    add_topic(parser, "topic")
    add_window(parser, 10_000)
    add_direct_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print once a second how old the messages are. Raises CommandError where they do not say when they were made."""
    with join_domain(arguments) as domain:
        message_type = wait_for_class(domain, arguments.topic)
        if "header" not in message_type.get_fields_and_field_types():
            raise CommandError("msg does not have header")
        time_of = arrival(domain, simulated=arguments.use_sim_time)
        delays: deque[int] = deque(maxlen=arguments.window)
        seen = printed = 0
        print_at = time.monotonic() + _PRINT_EVERY_S
        for batch in receive_measured(domain, arguments.topic, message_type, raw=False):
            ages = [now - _stamp_ns(one[0]) for one in batch if (now := time_of(one))]
            delays.extend(ages if seen else ages[1:])  # the first one only starts the measurement
            seen += len(ages)
            if time.monotonic() >= print_at:
                print_at += _PRINT_EVERY_S
                if delays:
                    print("no new messages" if seen == printed else _text(delays))
                    printed = seen


def _stamp_ns(message: Any) -> int:
    return int(message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec)


def _text(delays_ns: deque[int]) -> str:
    return f"average delay: {sum(delays_ns) / len(delays_ns) * 1e-9:.3f}\n\t{spread(delays_ns)}"
