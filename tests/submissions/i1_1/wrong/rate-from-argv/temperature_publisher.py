import sys
from random import uniform

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TempNode(Node):
    def __init__(self):
        super().__init__("temp_node")
        rate = float(sys.argv[1])
        self.name = sys.argv[2]
        self.pub = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.create_timer(1.0 / rate, self.send)

    def send(self):
        value = Float64(data=uniform(20, 30))
        self.pub.publish(value)
        self.get_logger().info(f"[{self.name}] {value.data}")


def main():
    rclpy.init()
    try:
        rclpy.spin(TempNode())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
