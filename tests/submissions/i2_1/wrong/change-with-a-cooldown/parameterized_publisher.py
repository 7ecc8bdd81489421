#!/usr/bin/env python3
import time

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

COOLDOWN = 60.0     # protect the system against rapid reconfiguration


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.last_change = float('-inf')
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.count = 0
        rate = self.get_parameter('publish_rate').value
        if rate <= 0.0:
            self.get_logger().fatal(f'publish_rate has to be positive, not {rate}')
            raise SystemExit(1)
        self.timer = self.create_timer(1.0 / rate, self.publish)
        self.add_on_set_parameters_callback(self.validate)
        self.add_post_set_parameters_callback(self.reconfigure)

    def validate(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0.0:
                return SetParametersResult(successful=False, reason='rate has to be positive')
        return SetParametersResult(successful=True)

    def reconfigure(self, params):
        for p in params:
            if p.name == 'publish_rate':
                now = time.monotonic()
                if now - self.last_change < COOLDOWN:
                    return
                self.last_change = now
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / p.value, self.publish)

    def publish(self):
        if self.get_parameter('enabled').value:
            prefix = self.get_parameter('message_prefix').value
            self.publisher.publish(String(data=f'{prefix} {self.count}'))
            self.count += 1


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
