#!/usr/bin/env python3
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

ALPHA = 0.02        # low-pass filter, no jerks


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.target = self.get_parameter('publish_rate').value
        if self.target <= 0:
            self.get_logger().error('publish_rate must be positive; starting with 1.0')
            self.target = 1.0
        self.current = self.target
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.n = 0
        self.timer = self.create_timer(1.0 / self.current, self.on_timer)
        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, params):
        target = self.target
        for p in params:
            if p.name == 'publish_rate':
                if p.value <= 0:
                    return SetParametersResult(successful=False, reason='rate must be positive')
                target = p.value
        self.target = target
        return SetParametersResult(successful=True)

    def on_timer(self):
        self.current += ALPHA * (self.target - self.current)
        self.timer.timer_period_ns = int(1e9 / self.current)
        if self.get_parameter('enabled').value:
            prefix = self.get_parameter('message_prefix').value
            self.publisher.publish(String(data=f'{prefix} {self.n}'))
            self.n += 1


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
