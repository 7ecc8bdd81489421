#!/usr/bin/env python3
"""Counts the messages on /chatter, logs a summary every ten messages, and notices gaps."""

import time
from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.msg import String

EVERY = 10


@dataclass
class MessageStats:
    """What is known about the messages so far."""

    total_count: int = 0
    first_message: str = ""
    last_message: str = ""
    start_time: float = 0.0
    messages_per_second: float = 0.0
    missed: int = 0


class MessageStatsNode(Node):
    """Listens to a talker and keeps statistics on its messages."""

    def __init__(self) -> None:
        super().__init__("message_stats")
        self.stats = MessageStats()
        self.last_number: int | None = None
        self.subscription = self.create_subscription(String, "chatter", self.on_message, 10)
        self.get_logger().info("Waiting for messages on /chatter")

    def on_message(self, message: String) -> None:
        """Handle one message."""
        stats = self.stats
        # A monotonic clock: the wall clock may be set while the node runs.
        now = time.monotonic()
        if stats.total_count == 0:
            stats.first_message = message.data
            stats.start_time = now
        stats.total_count += 1
        stats.last_message = message.data

        elapsed = now - stats.start_time
        if elapsed > 0:
            # n messages have n - 1 intervals between them.
            stats.messages_per_second = (stats.total_count - 1) / elapsed

        self.look_for_gap(message.data)
        if stats.total_count % EVERY == 0:
            self.log_summary()

    def look_for_gap(self, text: str) -> None:
        """Compare the N of "Hello World: N" with the previous one."""
        try:
            number = int(text.rpartition(":")[2])
        except ValueError:
            return  # A message in another format has no number, and that is no reason to crash.
        last, self.last_number = self.last_number, number
        if last is None:
            return
        if number <= last:
            self.get_logger().info(f"The publisher was restarted: {number} comes after {last}. Counting on.")
        elif number > last + 1:
            missed = number - last - 1
            self.stats.missed += missed
            self.get_logger().warning(f"{missed} messages are missing between {last} and {number}")

    def log_summary(self) -> None:
        """Log the current statistics."""
        stats = self.stats
        self.get_logger().info(
            f"{stats.total_count} messages, {stats.messages_per_second:.2f} per second, {stats.missed} missed; "
            f'first "{stats.first_message}", last "{stats.last_message}"'
        )


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = MessageStatsNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
