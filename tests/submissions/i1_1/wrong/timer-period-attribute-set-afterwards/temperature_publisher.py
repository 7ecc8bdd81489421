#!/usr/bin/env python3
"""
Sensor task. Same shape as my tasks on the microcontroller:
construct -> configure() -> start()
"""
import random

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class SensorTask:

    DEFAULT_PERIOD = 1.0

    def __init__(self, node: Node):
        self.node = node
        self.name = ''
        self.running = False
        self.pub = node.create_publisher(Float64, '/sensor/temperature', 10)
        self.ticker = node.create_timer(self.DEFAULT_PERIOD, self.on_tick)

    def configure(self):
        self.node.declare_parameter('sensor_name', 'ntc0')
        self.node.declare_parameter('frequency', 1.0)
        self.name = self.node.get_parameter('sensor_name').value
        hz = self.node.get_parameter('frequency').value
        self.ticker.period = 1.0 / hz
        self.node.get_logger().info('%s configured, tick every %.3f s' % (self.name, self.ticker.period))

    def start(self):
        self.running = True

    def stop(self):
        self.running = False
        self.ticker.cancel()

    def on_tick(self):
        if not self.running:
            return
        t = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=t))
        self.node.get_logger().info('%s %.2f' % (self.name, t))


def main():
    rclpy.init()
    node = Node('temperature_publisher')
    task = SensorTask(node)
    task.configure()
    task.start()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        task.stop()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
