#!/usr/bin/env python3
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.total_count = 0
        self.start_time = None
        self.first_message = None
        self.last_message = None
        self.expected = None
        self.lost = 0
        self.reported = 0
        self.create_subscription(String, "chatter", self.on_message, 10)
        self.create_timer(1.0, self.report)

    def on_message(self, msg):
        if self.first_message is None:
            self.first_message = msg.data
            self.start_time = time.time()
        self.total_count += 1
        self.last_message = msg.data
        number = int(msg.data.rsplit(" ", 1)[1])
        if self.expected is not None and number > self.expected:
            self.lost += number - self.expected
        self.expected = number + 1
        self.last_time = time.time()

    def report(self):
        """Looks once a second whether ten more have come."""
        if self.total_count // 10 == self.reported:
            return
        self.reported = self.total_count // 10
        rate = (self.total_count - 1) / (self.last_time - self.start_time)
        self.get_logger().info(
            f"{self.total_count} messages, {self.lost} lost, {rate:.2f} Hz, "
            f"from '{self.first_message}' to '{self.last_message}'"
        )


def main():
    rclpy.init()
    node = MessageStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
