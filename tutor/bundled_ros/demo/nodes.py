"""`talker` and `listener`, which behave like the nodes of `demo_nodes_py` and `demo_nodes_cpp`.

Run this file by its path with any Python that has rclpy; it imports none of our own code.

    nodes.py demo_nodes_py|demo_nodes_cpp talker|listener [--ros-args ...]
"""

from __future__ import annotations

import contextlib
import sys

import rclpy
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import ok, try_shutdown
from std_msgs.msg import String

# How the two packages' talkers differ: the first count, the queue depth, the quotes in the log, and the timer's clock.
# A timer of the C++ node is not affected by `use_sim_time`.
_TALKERS = {
    "demo_nodes_py": (0, 10, '"', ClockType.ROS_TIME),
    "demo_nodes_cpp": (1, 7, "'", ClockType.STEADY_TIME),
}


class Talker(Node):
    """Publishes `Hello World: N` on `chatter` once a second."""

    def __init__(self, package: str) -> None:
        super().__init__("talker")
        self._count, depth, self._quote, clock_type = _TALKERS[package]
        self._publisher = self.create_publisher(String, "chatter", depth)
        clock = self.get_clock() if clock_type is ClockType.ROS_TIME else Clock(clock_type=clock_type)
        self._timer = self.create_timer(1.0, self._publish, clock=clock)

    def _publish(self) -> None:
        message = String(data=f"Hello World: {self._count}")
        self._count += 1
        self.get_logger().info(f"Publishing: {self._quote}{message.data}{self._quote}")  # type: ignore[no-untyped-call]
        self._publisher.publish(message)


class Listener(Node):
    """Logs each message on `chatter`."""

    def __init__(self) -> None:
        super().__init__("listener")
        self._subscription = self.create_subscription(String, "chatter", self._on_message, 10)

    def _on_message(self, message: String) -> None:
        self.get_logger().info(f"I heard: [{message.data}]")  # type: ignore[no-untyped-call]


def main() -> None:
    """Run one node until Ctrl+C."""
    package, program, *arguments = sys.argv[1:]
    try:
        rclpy.init(args=[program, *arguments])
        _spin(package, program)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        with contextlib.suppress(RuntimeError):  # rclpy's own: Ctrl+C shut the context down just before we would
            try_shutdown()


def _spin(package: str, program: str) -> None:
    try:
        rclpy.spin(Talker(package) if program == "talker" else Listener())
    except RuntimeError:  # rclpy's own: Ctrl+C shut the context down just before a call that needs it
        if ok():
            raise


if __name__ == "__main__":
    main()
