#!/usr/bin/env python3
"""Publishes "<prefix> <n>" on chatter, as its parameters say."""
import rclpy
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.declare_parameter('message_prefix', 'Hello', ParameterDescriptor(description='text before the number'))
        self.declare_parameter('publish_rate', 1.0, ParameterDescriptor(description='messages per second'))
        self.declare_parameter('enabled', True, ParameterDescriptor(description='whether to publish'))
        self.n = 0
        self.publisher = self.create_publisher(String, '/chatter', 10)
        rate = self.value('publish_rate')
        problem = self.check(rate)
        if problem:
            raise SystemExit(f'bad parameter: {problem}')
        self.timer = self.create_timer(1 / rate, self.publish)
        self.add_on_set_parameters_callback(self.validate)
        self.add_post_set_parameters_callback(self.apply)

    def value(self, name):
        return self.get_parameter(name).value

    def check(self, rate):
        if rate <= 0:
            return f'publish_rate must be greater than 0 Hz (got {rate})'
        return ''

    def validate(self, params):
        for p in params:
            if p.name == 'publish_rate':
                problem = self.check(p.value)
                if problem:
                    return SetParametersResult(successful=False, reason=problem)
        return SetParametersResult(successful=True)

    def apply(self, params):
        for p in params:
            if p.name == 'publish_rate':
                self.timer.cancel()
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(min(1.0, 1 / p.value), self.publish)
            self.get_logger().info(f'{p.name} is now {p.value}')

    def publish(self):
        if self.value('enabled'):
            self.n += 1
            msg = String()
            msg.data = f"{self.value('message_prefix')} {self.n}"
            self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = None
    try:
        node = Talker()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
