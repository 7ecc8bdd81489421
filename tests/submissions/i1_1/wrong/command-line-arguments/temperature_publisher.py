import random
import sys
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self, rate, name):
        super().__init__('temperature_publisher')
        self.name = name
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / rate, self.cb)

    def cb(self):
        self.pub.publish(Float64(data=random.uniform(20.0, 30.0)))
        self.get_logger().info(self.name)


def main():
    rclpy.init()
    try:
        rate, name = float(sys.argv[1]), sys.argv[2]
    except (IndexError, ValueError):
        rate, name = 2.0, 'sensor'
    try:
        rclpy.spin(TemperaturePublisher(rate, name))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
