"""What `hz`, `bw` and `delay` share: the topic, its arriving messages and the window size."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from tutor.bundled_ros.ros2.domain import Domain
from tutor.bundled_ros.ros2.parsing import complete_with, positive_int
from tutor.bundled_ros.ros2.receiving import receive
from tutor.bundled_ros.ros2.topic.names import topic_names
from tutor.ros.batches import DEPTH, Received

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

_BATCH_PERIOD_S = 0.05


def add_topic(parser: argparse.ArgumentParser, name: str) -> None:
    """Add the topic, as the argument `name`."""
    complete_with(parser.add_argument(name, help="the topic, such as /chatter"), topic_names)


def add_window(parser: argparse.ArgumentParser, default: int, dest: str = "window") -> None:
    """Add --window, the number of messages in the statistics."""
    parser.add_argument(
        "--window",
        "-w",
        dest=dest,
        type=positive_int,
        default=default,
        metavar="WINDOW",
        help=f"how many of the last messages count (default: {default})",
    )


def receive_measured(domain: Domain, topic: str, message_type: Any, *, raw: bool) -> Iterator[list[Received]]:
    """Yield messages in batches, with the QoS of ros2cli's measurements and a longer queue."""
    return receive(domain, topic, message_type, _qos(), raw=raw, gather_s=_BATCH_PERIOD_S)


def arrival_clock(domain: Domain, *, simulated: bool) -> Callable[[Received], int]:
    """Return a function from a message to its arrival time in ns; 0 until simulated time has started."""
    clock = domain.node.get_clock()
    if simulated:
        return lambda _: int(clock.now().nanoseconds)
    return lambda one: int(one[1]["received_timestamp"])


def _qos() -> QoSProfile:
    from rclpy.qos import QoSPresetProfiles

    profile: QoSProfile = QoSPresetProfiles.get_from_short_key("sensor_data")
    profile.depth = DEPTH
    return profile
