import sys

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterValueException
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello', ParameterDescriptor(description='start of each message'))
        self.declare_parameter('publish_rate', 1.0, ParameterDescriptor(
            description='Hz', floating_point_range=[FloatingPointRange(from_value=0.1, to_value=100.0)]))
        self.declare_parameter('enabled', True, ParameterDescriptor(description='publish at all?'))
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.count = 0
        self.timer = None
        self.make_timer()
        self.add_post_set_parameters_callback(self.after_set)

    def make_timer(self):
        if self.timer:
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.publish)

    def after_set(self, params):
        if any(p.name == 'publish_rate' for p in params):
            self.make_timer()

    def publish(self):
        if self.get_parameter('enabled').value:
            self.publisher.publish(String(data=f"{self.get_parameter('message_prefix').value}: {self.count}"))
            self.count += 1


def main():
    rclpy.init()
    try:
        node = ParameterizedPublisher()
    except InvalidParameterValueException as e:
        print('Cannot start:', e, file=sys.stderr)
        rclpy.try_shutdown()
        sys.exit(1)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
