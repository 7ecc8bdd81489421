import time
from collections import deque

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Collector(Node):
    def __init__(self, lines):
        super().__init__("collector")
        self.lines, self.total, self.number = lines, 0, None
        self.create_subscription(String, "chatter", self.collect, 10)

    def collect(self, message):
        if not self.total:
            self.first, self.began = message.data, time.monotonic()
        self.total += 1
        number = int(message.data.split()[-1])
        if self.number is not None and number > self.number + 1:
            self.lines.append(f"{number - self.number - 1} messages missed")
        self.number = number
        if self.total % 10 == 0:
            rate = self.total / (time.monotonic() - self.began)
            self.lines.append(f"{self.total} so far, {rate:.1f}/s, from '{self.first}' to '{message.data}'")


class Printer(Node):
    def __init__(self, lines):
        super().__init__("printer")
        self.lines = lines
        self.create_timer(0.05, self.print_lines)

    def print_lines(self):
        while self.lines:
            self.get_logger().info(self.lines.popleft())


def main():
    rclpy.init()
    lines = deque()
    collector = Collector(lines)
    printer = Printer(lines)
    try:
        rclpy.spin(printer)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        collector.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
