import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class Thermometer(Node):
    def __init__(self):
        super().__init__('thermometer')
        rate = self.declare_parameter('publish_rate', 2.0).value
        self.declare_parameter('sensor_name', 'kitchen')
        self.pub = self.create_publisher(Float64, 'sensor/temperature', 10)
        for name in ('publish_rate', 'sensor_name'):
            self.get_logger().info(f'{name}:={self.get_parameter(name).value}')
        self.create_timer(1.0 / rate, self.measure)

    def measure(self):
        self.pub.publish(Float64(data=random.uniform(20.0, 30.0)))


def main():
    rclpy.init()
    try:
        rclpy.spin(Thermometer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
