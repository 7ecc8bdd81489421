#!/usr/bin/env python3
"""Statistics on /chatter."""

from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


@dataclass
class MessageStats:
    total_count: int = 0
    first_message: str = ""
    last_message: str = ""
    start_time: float = 0.0
    messages_per_second: float = 0.0


class MessageStatsNode(Node):

    def __init__(self):
        super().__init__("message_stats")
        self.stats = MessageStats()
        self.last_number = None
        self.sub = self.create_subscription(
            String, "chatter", self.listener_callback, 50
        )
        self.get_logger().info("Listening on /chatter ...")

    def seconds(self):
        """The time now, in seconds."""
        return self.get_clock().now().to_msg().nanosec / 1e9

    def listener_callback(self, msg):
        s = self.stats
        if s.total_count == 0:
            s.first_message = msg.data
            s.start_time = self.seconds()

        s.total_count += 1
        s.last_message = msg.data

        duration = self.seconds() - s.start_time
        if duration > 0:
            s.messages_per_second = (s.total_count - 1) / duration

        number = self.number_of(msg.data)
        if number is not None:
            if self.last_number is not None and number - self.last_number > 1:
                lost = number - self.last_number - 1
                self.get_logger().warn(
                    f"GAP: {lost} missing ({self.last_number} -> {number})"
                )
            self.last_number = number

        if s.total_count % 10 == 0:
            self.get_logger().info(
                "--- Summary ---\n"
                f"count: {s.total_count}\n"
                f"rate: {s.messages_per_second:.2f} msg/s\n"
                f"first: {s.first_message}\n"
                f"last: {s.last_message}"
            )

    @staticmethod
    def number_of(text):
        try:
            return int(text.rsplit(" ", 1)[-1])
        except ValueError:
            return None


def main():
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
