#!/usr/bin/env python3
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStatsNode(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.last_number = None
        self.reset()
        self.create_subscription(String, "chatter", self.on_message, 10)

    def reset(self):
        self.total_count = 0
        self.first_message = ""
        self.start_time = 0.0

    def on_message(self, message):
        now = time.monotonic()
        try:
            number = int(message.data.split(":")[1])
        except (IndexError, ValueError):
            return
        if self.last_number is not None:
            if number <= self.last_number:
                self.get_logger().warning("Publisher restarted: the statistics start again at zero")
                self.reset()
                self.last_number = number
                return
            if number > self.last_number + 1:
                self.get_logger().warning(f"{number - self.last_number - 1} messages are missing")
        self.last_number = number

        if self.total_count == 0:
            self.first_message = message.data
            self.start_time = now
        self.total_count += 1
        if self.total_count % 10 == 0:
            rate = (self.total_count - 1) / (now - self.start_time)
            self.get_logger().info(
                f"total={self.total_count}, rate={rate:.2f} msg/s, "
                f'first="{self.first_message}", last="{message.data}"'
            )


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
