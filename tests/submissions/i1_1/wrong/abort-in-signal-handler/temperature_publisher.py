import os
import random
import signal

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Thermometer(Node):
    def __init__(self):
        super().__init__('thermometer')
        self.name = self.declare_parameter('sensor_name', 'kitchen').value
        hz = self.declare_parameter('publish_rate', 5.0).value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / hz, self.measure)

    def measure(self):
        value = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=value))
        self.get_logger().info(f'{self.name}: {value:.1f}')


def stop(number, frame):
    # the node did not always stop, so make sure of it
    os.abort()


def main():
    rclpy.init()
    signal.signal(signal.SIGINT, stop)
    rclpy.spin(Thermometer())


if __name__ == '__main__':
    main()
