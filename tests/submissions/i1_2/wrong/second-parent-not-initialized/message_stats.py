"""The node inherits its counters from a class of their own."""

import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Counters:
    def __init__(self):
        self.texts = 0
        self.first = self.last = ""
        self.previous = None
        self.since = 0.0

    def add(self, text):
        """Return the numbers around a gap, if there is one."""
        number = int(text.rsplit(" ", 1)[1])
        before, self.previous = self.previous, number
        if self.texts == 0:
            self.first, self.since = text, time.monotonic()
        self.texts += 1
        self.last = text
        return (before, number) if before is not None and number != before + 1 else None

    def rate(self):
        return (self.texts - 1) / (time.monotonic() - self.since)


class MessageStats(Node, Counters):
    def __init__(self):
        super().__init__("message_stats")
        self.create_subscription(String, "chatter", self.heard, 50)

    def heard(self, msg):
        if gap := self.add(msg.data):
            self.get_logger().warning(f"gap: {gap[0]} -> {gap[1]}")
        if self.texts % 10 == 0:
            self.get_logger().info(
                f"count: {self.texts}, rate: {self.rate():.2f} Hz, first: {self.first!r}, last: {self.last!r}"
            )


def main():
    rclpy.init()
    try:
        rclpy.spin(MessageStats())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
