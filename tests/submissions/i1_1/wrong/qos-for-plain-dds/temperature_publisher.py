import random

import rclpy
from qos import READINGS
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.sensor_name = self.declare_parameter('sensor_name', 'attic').value
        rate = self.declare_parameter('publish_rate', 2.0).value
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', READINGS)
        self.timer = self.create_timer(1.0 / rate, self.publish)

    def publish(self):
        reading = Float64(data=random.uniform(20.0, 30.0))
        self.publisher.publish(reading)
        self.get_logger().info(f'{self.sensor_name}: {reading.data:.1f}')


def main():
    rclpy.init()
    try:
        rclpy.spin(TemperaturePublisher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
