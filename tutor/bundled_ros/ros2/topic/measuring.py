"""`ros2 topic hz`, `bw` and `delay`."""

from __future__ import annotations

import argparse
import time
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any

from tutor.bundled_ros.ros2.arguments import DIRECT
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import TOPICS
from tutor.bundled_ros.ros2.parsing import Argument, Verb, argument, flag, positive_int
from tutor.bundled_ros.ros2.receiving import receive
from tutor.bundled_ros.ros2.topic.expressions import compile_filter
from tutor.bundled_ros.ros2.topic.statistics import Rate, format_size, spread
from tutor.bundled_ros.ros2.topic.types import wait_for_class
from tutor.errors import CommandError
from tutor.ros.batches import DEPTH, Received
from tutor.ros_model import Timing

_BATCH_PERIOD_S = 0.05
_PRINT_PERIOD_S = 1.0


def _hz(arguments: argparse.Namespace) -> None:
    """Print the rate once a second until Ctrl+C. Raises CommandError."""
    matches = compile_filter(arguments.filter_expr)
    with join_domain(arguments) as domain:
        message_type = wait_for_class(domain, arguments.topic_name)
        rate = Rate(arguments.window)
        time_of = _arrival_clock(domain, simulated=arguments.use_sim_time and not arguments.use_wtime)
        for batch in _receive(domain, arguments.topic_name, message_type, raw=matches is None):
            for received in batch:
                if matches is not None and not matches(received[0]):
                    continue
                if (text := rate.add(time_of(received))) is not None:
                    print(text)


def _bw(arguments: argparse.Namespace) -> None:
    """Print the bandwidth once a second until Ctrl+C. Raises CommandError."""
    with join_domain(arguments) as domain:
        message_type = wait_for_class(domain, arguments.topic)
        time_of = _arrival_clock(domain, simulated=arguments.use_sim_time)
        clock = domain.node.get_clock()
        arrivals: deque[tuple[int, int]] = deque(maxlen=arguments.window)
        print(f"Subscribed to [{arguments.topic}]")
        print_at = time.monotonic() + _PRINT_PERIOD_S
        for batch in _receive(domain, arguments.topic, message_type, raw=True):
            arrivals.extend((time_of(received), len(received[0])) for received in batch)
            if time.monotonic() >= print_at:
                print_at += _PRINT_PERIOD_S
                _print_bandwidth(arrivals, clock.now().nanoseconds)


def _print_bandwidth(arrivals: deque[tuple[int, int]], now_ns: int) -> None:
    if len(arrivals) < 2 or now_ns <= arrivals[0][0]:
        return
    sizes = [size for _, size in arrivals]
    rate = sum(sizes) / ((now_ns - arrivals[0][0]) * 1e-9)
    mean, smallest, largest = (format_size(size, rate) for size in (sum(sizes) / len(sizes), min(sizes), max(sizes)))
    print(
        f"{format_size(rate, rate)}/s from {len(sizes)} messages\n"
        f"\tMessage size mean: {mean} min: {smallest} max: {largest}"
    )


def _delay(arguments: argparse.Namespace) -> None:
    """Print the messages' age on arrival once a second. Raises CommandError if the type has no header."""
    with join_domain(arguments) as domain:
        message_type = wait_for_class(domain, arguments.topic)
        if "header" not in message_type.get_fields_and_field_types():
            raise CommandError("msg does not have header")
        time_of = _arrival_clock(domain, simulated=arguments.use_sim_time)
        delays: deque[int] = deque(maxlen=arguments.window)
        received = printed_up_to = 0
        print_at = time.monotonic() + _PRINT_PERIOD_S
        for batch in _receive(domain, arguments.topic, message_type, raw=False):
            ages = [now - _stamp_ns(message[0]) for message in batch if (now := time_of(message))]
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


def _receive(domain: Domain, topic: str, message_type: Any, *, raw: bool) -> Iterator[list[Received]]:
    """Yield messages in batches, with the QoS of ros2cli's measurements and a longer queue."""
    from rclpy.qos import QoSPresetProfiles

    profile = QoSPresetProfiles.get_from_short_key("sensor_data")
    profile.depth = DEPTH
    return receive(domain, topic, message_type, profile, raw=raw, gather_s=_BATCH_PERIOD_S)


def _arrival_clock(domain: Domain, *, simulated: bool) -> Callable[[Received], int]:
    """Return a function from a message to its arrival time in ns; 0 until simulated time has started."""
    clock = domain.node.get_clock()
    if simulated:
        return lambda _: int(clock.now().nanoseconds)
    return lambda received: int(received[1]["received_timestamp"])


def _window(default: int) -> Argument:
    """Return the option for the number of messages in the statistics."""
    help_text = f"how many of the last messages count (default: {default})"
    return argument(
        "--window", "-w", dest="window", type=positive_int, default=default, metavar="WINDOW", help=help_text
    )


GRAMMAR = {
    "bw": Verb(_bw, TOPICS.argument("topic"), _window(100), *DIRECT),
    "delay": Verb(_delay, TOPICS.argument("topic"), _window(10_000), *DIRECT),
    "hz": Verb(
        _hz,
        TOPICS.argument(),
        _window(10_000),
        argument(
            "--filter",
            dest="filter_expr",
            metavar="EXPR",
            help="only messages m for which this Python expression is true",
        ),
        flag("--wall-time", dest="use_wtime", help="this machine's time, also with --use-sim-time"),
        *DIRECT,
    ),
}
