"""Twenty parameters of 20 MB, beside those that are asked for."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Hostile(Node):
    def __init__(self):
        super().__init__("hostile")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.declare_parameter("message_prefix", "Hello")
        self.declare_parameter("publish_rate", 1.0)
        self.declare_parameter("enabled", True)
        for number in range(20):
            self.declare_parameter(f"big_{number}", "x" * 20_000_000)
        self.create_timer(1.0, lambda: self.publisher.publish(String(data="Hello")))


def main():
    rclpy.init()
    rclpy.spin(Hostile())


if __name__ == "__main__":
    main()
