#!/usr/bin/env python3
"""Two flavours of the temperature publisher, each one in a process of its own
(rclpy.spin() blocks, so they cannot share one)."""
import random
import sys
from multiprocessing import Process

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Temperature
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    """Plain number, as the exercise asks for it."""

    node_name = 'temperature_publisher'
    topic = '/sensor/temperature'
    msg_type = Float64

    def __init__(self):
        super().__init__(self.node_name)
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'greenhouse')
        self.sensor_name = self.get_parameter('sensor_name').value
        self.pub = self.create_publisher(self.msg_type, self.topic, 10)
        self.timer = self.create_timer(
            1.0 / self.get_parameter('publish_rate').value, self.on_timer)
        self.get_logger().info(f'{self.sensor_name}: {self.msg_type.__name__} on {self.topic}')

    def fill(self, msg, celsius):
        msg.data = celsius

    def on_timer(self):
        msg = self.msg_type()
        celsius = random.uniform(20.0, 30.0)
        self.fill(msg, celsius)
        self.pub.publish(msg)
        self.get_logger().info(f'{self.sensor_name}: {celsius:.2f} C')


class StampedTemperaturePublisher(TemperaturePublisher):
    """With a header, for robot_localization and rviz."""

    node_name = 'stamped_temperature_publisher'
    msg_type = Temperature

    def fill(self, msg, celsius):
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = self.sensor_name
        msg.temperature = celsius


def run(cls):
    rclpy.init(args=sys.argv)
    node = cls()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def main():
    jobs = [Process(target=run, args=(cls,))
            for cls in (TemperaturePublisher, StampedTemperaturePublisher)]
    for job in jobs:
        job.start()
    try:
        for job in jobs:
            job.join()
    except KeyboardInterrupt:
        for job in jobs:
            job.join()


if __name__ == '__main__':
    main()
