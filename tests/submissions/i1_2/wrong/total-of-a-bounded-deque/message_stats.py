"""Counts what is in a deque of the last twenty arrivals."""

import re
import time
from collections import deque

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.arrivals = deque(maxlen=20)
        self.first = None
        self.number = None
        self.create_subscription(String, "chatter", self.on_message, 10)

    def on_message(self, message):
        self.arrivals.append(time.monotonic())
        self.first = self.first or message.data
        number = int(re.search(r"\d+$", message.data)[0])
        if self.number is not None and number > self.number + 1:
            self.get_logger().warning(f"lost {number - self.number - 1} messages before {number}")
        self.number = number
        if len(self.arrivals) % 10 == 0:
            elapsed = self.arrivals[-1] - self.arrivals[0]
            self.get_logger().info(
                f"{len(self.arrivals)} messages at {(len(self.arrivals) - 1) / elapsed:.1f} Hz, "
                f"from '{self.first}' to '{message.data}'"
            )


def main():
    rclpy.init()
    node = Stats()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
