#!/usr/bin/env python3
import sys

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)

        start = self.get_parameters(['message_prefix', 'publish_rate', 'enabled'])
        verdict = self.validate(start)
        if not verdict.successful:
            raise ValueError(verdict.reason)

        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = None
        self.seq = 0
        self.apply(start)

        # The callback that is added last is called first, and the first refusal ends the chain.
        self.add_on_set_parameters_callback(self.apply)
        self.add_on_set_parameters_callback(self.validate)

    def validate(self, params):
        for p in params:
            if p.name == 'publish_rate' and not p.value > 0.0:
                return SetParametersResult(
                    successful=False, reason=f'publish_rate: {p.value} Hz is not a positive rate')
        return SetParametersResult(successful=True)

    def apply(self, params):
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'enabled':
                self.enabled = p.value
            elif p.name == 'publish_rate':
                old, self.timer = self.timer, self.create_timer(1.0 / p.value, self.tick)
                if old is not None:
                    self.destroy_timer(old)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.enabled:
            self.pub.publish(String(data=f'{self.prefix} #{self.seq}'))
            self.seq += 1


def main():
    rclpy.init()
    try:
        node = ParameterizedPublisher()
    except ValueError as error:
        print(f'cannot start: {error}', file=sys.stderr)
        rclpy.try_shutdown()
        return 1
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
