#!/usr/bin/env python3
import random
import threading

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'threaded')
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.on_timer)

    def on_timer(self):
        value = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=value))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value} = {value:.2f}")


def main():
    rclpy.init()
    node = TemperaturePublisher()
    spinner = threading.Thread(target=rclpy.spin, args=(node,))
    spinner.start()
    try:
        spinner.join()
    except KeyboardInterrupt:
        pass
    spinner.join()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
