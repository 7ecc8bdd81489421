#!/usr/bin/env python3
"""Statistics on /chatter. Now with slots, as the review asked for."""

from __future__ import annotations

import time
from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


@dataclass(slots=True)
class MessageStats:
    total_count: int = 0
    first_message: str = ""
    last_message: str = ""
    start_time: float = 0.0
    messages_per_second: float = 0.0
    last_number: int | None = None
    lost: int = 0

    def add(self, text: str) -> None:
        now = time.monotonic()
        if self.total_count == 0:
            self.first_message = text
            self.start_time = now
        self.total_count += 1
        self.last_message = text
        elapsed = now - self.start_time
        if elapsed > 0.0:
            self.messages_per_second = (self.total_count - 1) / elapsed


class MessageStatsNode(Node):
    def __init__(self) -> None:
        super().__init__("message_stats")
        self.stats = MessageStats()
        self.subscription = self.create_subscription(
            String, "chatter", self.on_message, 50
        )

    def on_message(self, message: String) -> None:
        self.stats.add(message.data)
        self.check_sequence(message.data)
        if self.stats.total_count % 10 == 0:
            self.log_summary()

    def check_sequence(self, text: str) -> None:
        try:
            number = int(text.rsplit(" ", 1)[-1])
        except ValueError:
            return
        previous = self.stats.last_number
        self.stats.last_number = number
        if previous is None or number == previous + 1:
            return
        if number <= previous:
            self.get_logger().warning("The publisher has started over")
            self.stats.restarted_at = time.monotonic()
            return
        missing = number - previous - 1
        self.stats.lost += missing
        self.get_logger().warning(f"Gap: {missing} message(s) lost before {number}")

    def log_summary(self) -> None:
        s = self.stats
        self.get_logger().info(
            f"total={s.total_count} rate={s.messages_per_second:.2f} msg/s "
            f"first='{s.first_message}' last='{s.last_message}' lost={s.lost}"
        )


def main() -> None:
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
