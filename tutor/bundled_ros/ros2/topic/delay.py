"""`ros2 topic delay`."""

from __future__ import annotations

import argparse
import time
from collections import deque
from typing import Any

from tutor.bundled_ros.ros2.domain import add_direct_arguments, join_domain
from tutor.bundled_ros.ros2.topic.measuring import add_topic, add_window, arrival_clock, receive_measured
from tutor.bundled_ros.ros2.topic.names import wait_for_class
from tutor.bundled_ros.ros2.topic.statistics import spread
from tutor.errors import CommandError
from tutor.ros_model import Timing

_PRINT_PERIOD_S = 1.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TOPIC [-w N]."""
    add_topic(parser, "topic")
    add_window(parser, 10_000)
    add_direct_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the messages' age on arrival once a second. Raises CommandError if the type has no header."""
    with join_domain(arguments) as domain:
        message_type = wait_for_class(domain, arguments.topic)
        if "header" not in message_type.get_fields_and_field_types():
            raise CommandError("msg does not have header")
        time_of = arrival_clock(domain, simulated=arguments.use_sim_time)
        delays: deque[int] = deque(maxlen=arguments.window)
        received = printed_up_to = 0
        print_at = time.monotonic() + _PRINT_PERIOD_S
        for batch in receive_measured(domain, arguments.topic, message_type, raw=False):
            ages = [now - _stamp_ns(one[0]) for one in batch if (now := time_of(one))]
            delays.extend(ages if received else ages[1:])  # the first message only starts the measurement
            received += len(ages)
            if time.monotonic() >= print_at:
                print_at += _PRINT_PERIOD_S
                if delays:
                    print("no new messages" if received == printed_up_to else _format_delays(delays))
                    printed_up_to = received


def _stamp_ns(message: Any) -> int:
    return int(message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec)


def _format_delays(delays_ns: deque[int]) -> str:
    timing = Timing.of(delays_ns, 1e-9)
    return f"average delay: {timing.mean_s:.3f}\n\t{spread(timing)}"
