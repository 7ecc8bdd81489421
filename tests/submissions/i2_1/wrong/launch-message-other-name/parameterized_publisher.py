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
            self.get_logger().error(f'bad frequency {self.rate}; using 1.0')
            self.rate = 1.0
            self.set_parameters([rclpy.parameter.Parameter('publish_rate', value=1.0)])
        self.count = 0
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, params):
        for p in params:
            if p.name == 'publish_rate' and not p.value > 0.0:
                return SetParametersResult(successful=False, reason=f'publish_rate must be > 0, got {p.value}')
        for p in params:
            if p.name == 'publish_rate':
                self.rate = p.value
                self.timer.cancel()
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
            elif p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'enabled':
                self.enabled = p.value
        return SetParametersResult(successful=True)

    def timer_callback(self):
        if not self.enabled:
            return
        self.publisher.publish(String(data=f'{self.prefix} #{self.count}'))
        self.count += 1


def main(args=None):
    rclpy.init(args=args)
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
