#!/usr/bin/env python3
import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

SLOW, FAST = 1.0, 10.0


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', SLOW)
        self.declare_parameter('sensor_name', 'two_speed')
        wanted = self.get_parameter('publish_rate').value
        # the hardware knows only two modes
        rate = FAST if wanted > SLOW else SLOW
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / rate, self.timer_callback)
        self.get_logger().info(
            f"{self.get_parameter('sensor_name').value} at {rate} Hz (wanted {wanted})")

    def timer_callback(self):
        self.pub.publish(Float64(data=random.uniform(20.0, 30.0)))


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
