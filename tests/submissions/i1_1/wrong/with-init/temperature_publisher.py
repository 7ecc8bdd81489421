import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from std_msgs.msg import Float64


class TemperaturePublisher(Node):

    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'thermometer')
        self.publisher_ = self.create_publisher(Float64, '/sensor/temperature', 10)
        timer_period = 1.0 / self.get_parameter('publish_rate').value  # seconds
        self.timer = self.create_timer(timer_period, self.timer_callback)
        self.i = 0

    def timer_callback(self):
        msg = Float64()
        msg.data = 20.0 + random.random() * 10.0
        self.publisher_.publish(msg)
        name = self.get_parameter('sensor_name').value
        self.get_logger().info('%s: Publishing: "%s"' % (name, msg.data))
        self.i += 1


def main(args=None):
    # wait, spin, repeat


    try:
        with rclpy.init(args=args):
            node = TemperaturePublisher()

            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
