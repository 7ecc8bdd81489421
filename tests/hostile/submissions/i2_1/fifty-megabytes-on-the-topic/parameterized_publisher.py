"""Strings of 50 MB, ten times a second."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64, String


class Hostile(Node):
    def __init__(self):
        super().__init__("hostile")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.declare_parameter("message_prefix", "Hello")
        self.declare_parameter("publish_rate", 1.0)
        self.declare_parameter("enabled", True)
        self.message = String(data="Hello #0 " + "x" * 50_000_000)
        self.create_timer(0.1, lambda: self.publisher.publish(self.message))


def main():
    rclpy.init()
    rclpy.spin(Hostile())


if __name__ == "__main__":
    main()
