import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ChatterReport(Node):
    def __init__(self):
        super().__init__("chatter_report")
        self.opening = None
        self.newest = None
        self.seen = 0
        self.since = None
        self.create_subscription(String, "/chatter", self.heard, 10)
        while self.opening is None:
            self.get_logger().info("nobody talks yet")
            time.sleep(0.4)
        self.get_logger().info("there they are")

    def heard(self, message):
        number = int(message.data.split(": ")[1])
        if self.opening is None:
            self.opening, self.since = message.data, time.monotonic()
        elif number > self.number + 1:
            self.get_logger().warning(f"{number - self.number - 1} lost before {number}")
        self.number = number
        self.newest = message.data
        self.seen += 1
        if self.seen % 10 == 0:
            rate = self.seen / (time.monotonic() - self.since)
            self.get_logger().info(f"{self.seen} heard, {rate:.2f} Hz, first '{self.opening}', last '{self.newest}'")


def main():
    rclpy.init()
    try:
        rclpy.spin(ChatterReport())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
