#!/usr/bin/env python3
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
        self.prefix = self.get_parameter('message_prefix').value
        self.rate = self.get_parameter('publish_rate').value
        self.enabled = self.get_parameter('enabled').value
        if self.rate <= 0.0:
            self.get_logger().warning('publish_rate must be positive, starting with 1.0')
            self.rate = 1.0
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
        self.count = 0
        self.add_on_set_parameters_callback(self.param_callback)

    def param_callback(self, params):
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
                return SetParametersResult(successful=True)
            elif p.name == 'enabled':
                self.enabled = p.value
                return SetParametersResult(successful=True)
            elif p.name == 'publish_rate':
                if p.value <= 0.0:
                    return SetParametersResult(successful=False, reason='Rate must be positive')
                self.rate = p.value
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
                return SetParametersResult(successful=True)
        return SetParametersResult(successful=True)

    def timer_callback(self):
        if not self.enabled:
            return
        msg = String()
        msg.data = f'{self.prefix} #{self.count}'
        self.publisher.publish(msg)
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
