#!/usr/bin/env python3
"""Saves battery: no measurement is taken while nobody listens."""
import random
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):

    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameters('', [('publish_rate', 1.0), ('sensor_name', 'eco_sensor')])
        self.name = self.get_parameter('sensor_name').value
        period = 1 / self.get_parameter('publish_rate').value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(period, self.timer_callback)
        self.asleep = None

    def timer_callback(self):
        nobody = self.pub.get_subscription_count() == 0
        if nobody != self.asleep:
            self.asleep = nobody
            state = 'asleep, no subscribers' if nobody else 'awake'
            self.get_logger().info(f'{self.name} is {state}')
        if nobody:
            return
        msg = Float64()
        msg.data = random.uniform(20.0, 30.0)
        self.pub.publish(msg)


if __name__ == '__main__':
    rclpy.init()
    n = TemperaturePublisher()
    ex = SingleThreadedExecutor()
    ex.add_node(n)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        n.destroy_node()
        rclpy.try_shutdown()
