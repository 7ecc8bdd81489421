#!/usr/bin/env python3
"""Exercise I1.2: count the messages on /chatter, and log summaries."""

import time
from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


@dataclass
class MessageStats:
    """What we know about the talker."""

    total_count: int = 0
    first_message: str = ""
    last_message: str = ""
    start_time: float = 0.0
    messages_per_second: float = 0.0


class MessageStatsNode(Node):
    """Listens to a talker and keeps statistics on its messages."""

    def __init__(self) -> None:
        super().__init__("message_stats")
        self.stats = MessageStats()
        self.last_number = None
        self.subscription = self.create_subscription(
            String, "chatter", self.on_message, 10
        )
        self.get_logger().info("Waiting for messages on /chatter")

    def on_message(self, message: String) -> None:
        """Handle one message. rclpy calls this for each."""
        stats = self.stats
        now = time.monotonic()
        if stats.total_count == 0:
            stats.first_message = message.data
            stats.start_time = now

        stats.total_count += 1
        stats.last_message = message.data
        elapsed = now - stats.start_time
        if elapsed > 0:
            stats.messages_per_second = (stats.total_count - 1) / elapsed

        self.check_gap(message.data)

        if stats.total_count % 10 == 0:
            self.log_summary()

    def check_gap(self, text: str) -> None:
        """Warn if numbers were left out."""
        try:
            number = int(text.split(":")[-1])
        except ValueError:
            return
        if self.last_number is not None and number > self.last_number + 1:
            missing = number - self.last_number - 1
            self.get_logger().warning(
                f"{missing} message(s) lost between {self.last_number} "
                f"and {number}"
            )
        self.last_number = number

    def log_summary(self) -> None:
        """Log all four values in one line."""
        stats = self.stats
        self.get_logger().info(
            f"{stats.total_count} messages, "
            f"{stats.messages_per_second:.2f} per second, "
            f"first: '{stats.first_message}', "
            f"last: '{stats.last_message}'",
            throttle_duration_sec=30.0,
        )


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
    rclpy.init()
    node = MessageStatsNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
