"""`ros2 topic bw`."""

from __future__ import annotations

import argparse
import time
from collections import deque

from tutor.bundled_ros.ros2.domain import add_direct_arguments, join_domain
from tutor.bundled_ros.ros2.topic.measuring import add_topic, add_window, arrival_clock, receive_measured
from tutor.bundled_ros.ros2.topic.names import wait_for_class
from tutor.bundled_ros.ros2.topic.statistics import format_size

_PRINT_PERIOD_S = 1.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TOPIC [-w N]."""
    add_topic(parser, "topic")
    add_window(parser, 100)
    add_direct_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the bandwidth once a second until Ctrl+C. Raises CommandError."""
    with join_domain(arguments) as domain:
        message_type = wait_for_class(domain, arguments.topic)
        time_of = arrival_clock(domain, simulated=arguments.use_sim_time)
        clock = domain.node.get_clock()
        arrivals: deque[tuple[int, int]] = deque(maxlen=arguments.window)
        print(f"Subscribed to [{arguments.topic}]")
        print_at = time.monotonic() + _PRINT_PERIOD_S
        for batch in receive_measured(domain, arguments.topic, message_type, raw=True):
            arrivals.extend((time_of(one), len(one[0])) for one in batch)
            if time.monotonic() >= print_at:
                print_at += _PRINT_PERIOD_S
                _print(arrivals, clock.now().nanoseconds)


def _print(arrivals: deque[tuple[int, int]], now_ns: int) -> None:
    if len(arrivals) < 2 or now_ns <= arrivals[0][0]:
        return
    sizes = [each for _, each in arrivals]
    rate = sum(sizes) / ((now_ns - arrivals[0][0]) * 1e-9)
    mean, smallest, largest = (format_size(each, rate) for each in (sum(sizes) / len(sizes), min(sizes), max(sizes)))
    print(
        f"{format_size(rate, rate)}/s from {len(sizes)} messages\n"
        f"\tMessage size mean: {mean} min: {smallest} max: {largest}"
    )
