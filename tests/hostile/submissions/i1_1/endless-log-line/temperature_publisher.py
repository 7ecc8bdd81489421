"""Log lines of 280 KB that patterns take long for."""

import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64, String


class Hostile(Node):
    def __init__(self):
        super().__init__("hostile")
        self.publisher = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.create_timer(0.5, lambda: self.publisher.publish(Float64(data=25.0)))
        for text in ("1" * 280_000, "a." * 140_000, " " * 280_000, "'" * 280_000, "File \"" * 40_000, "x=" * 140_000):
            self.get_logger().info(text)
            print(text, flush=True)
            print(text, file=sys.stderr, flush=True)
        raise ValueError("parameter " + "a' " * 90_000)


def main():
    rclpy.init()
    rclpy.spin(Hostile())


if __name__ == "__main__":
    main()
