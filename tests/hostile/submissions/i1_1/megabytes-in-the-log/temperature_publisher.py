"""Log lines of a megabyte."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64, String


class Hostile(Node):
    def __init__(self):
        super().__init__("hostile")
        self.publisher = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.create_timer(0.5, lambda: self.publisher.publish(Float64(data=25.0)))
        self.create_timer(0.02, lambda: self.get_logger().info("x" * 1_000_000))


def main():
    rclpy.init()
    rclpy.spin(Hostile())


if __name__ == "__main__":
    main()
