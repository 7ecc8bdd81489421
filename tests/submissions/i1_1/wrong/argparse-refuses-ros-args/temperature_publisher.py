import argparse
import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class Thermometer(Node):
    def __init__(self, topic):
        super().__init__('thermometer')
        self.declare_parameter('frequency', 2.0)
        self.declare_parameter('sensor_name', 'kitchen')
        self.pub = self.create_publisher(Float64, topic, 10)
        self.create_timer(1.0 / self.get_parameter('frequency').value, self.measure)

    def measure(self):
        t = random.uniform(20, 30)
        self.pub.publish(Float64(data=t))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value} measures {t:.1f}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--topic', default='/sensor/temperature')
    args = parser.parse_args()
    rclpy.init()
    node = Thermometer(args.topic)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
