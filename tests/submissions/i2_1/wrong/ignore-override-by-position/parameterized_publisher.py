#!/usr/bin/env python3
"""
Parameterized publisher.

Publishes "<message_prefix> <n>" on /chatter. All three parameters can be given on the
command line and can be changed at runtime with `ros2 param set`.
"""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    """Publisher node with runtime-configurable parameters."""

    def __init__(self):
        super().__init__('parameterized_publisher')

        self._declare_parameters()
        self._load_parameters()

        self.publisher_ = self.create_publisher(String, 'chatter', 10)
        self.timer_ = self.create_timer(1.0 / self.publish_rate, self._timer_callback)
        self.count_ = 0

        # Register parameter callback for dynamic updates
        self.add_on_set_parameters_callback(self._parameter_callback)

        self.get_logger().info(
            f'Parameterized publisher started: prefix="{self.message_prefix}", '
            f'rate={self.publish_rate} Hz, enabled={self.enabled}')

    def _declare_parameters(self):
        """Declare all parameters with descriptors (last argument: allow override)."""
        self.declare_parameter(
            'message_prefix', 'Hello',
            ParameterDescriptor(
                type=ParameterType.PARAMETER_STRING,
                description='Prefix for published messages'),
            True)
        self.declare_parameter(
            'publish_rate', 1.0,
            ParameterDescriptor(
                type=ParameterType.PARAMETER_DOUBLE,
                description='Publishing rate in Hz',
                additional_constraints='must be > 0'),
            True)
        self.declare_parameter(
            'enabled', True,
            ParameterDescriptor(
                type=ParameterType.PARAMETER_BOOL,
                description='Enable/disable publishing'),
            True)

    def _load_parameters(self):
        """Load current parameter values into member variables."""
        self.message_prefix = self.get_parameter('message_prefix').get_parameter_value().string_value
        self.publish_rate = self.get_parameter('publish_rate').get_parameter_value().double_value
        self.enabled = self.get_parameter('enabled').get_parameter_value().bool_value

    def _validate(self, params):
        """Return an error message, or None if all values are acceptable."""
        for param in params:
            if param.name == 'publish_rate' and param.value <= 0.0:
                return f'publish_rate must be greater than 0.0, got {param.value}'
        return None

    def _parameter_callback(self, params):
        """Validate and apply parameter changes."""
        error = self._validate(params)
        if error is not None:
            self.get_logger().error(error)
            return SetParametersResult(successful=False, reason=error)

        for param in params:
            if param.name == 'message_prefix':
                self.message_prefix = param.value
            elif param.name == 'enabled':
                self.enabled = param.value
            elif param.name == 'publish_rate':
                self.publish_rate = param.value
                self._restart_timer()
        return SetParametersResult(successful=True)

    def _restart_timer(self):
        """Recreate the timer with the current rate."""
        self.timer_.cancel()
        self.destroy_timer(self.timer_)
        self.timer_ = self.create_timer(1.0 / self.publish_rate, self._timer_callback)

    def _timer_callback(self):
        """Publish one message if enabled."""
        if not self.enabled:
            return
        msg = String()
        msg.data = f'{self.message_prefix} {self.count_}'
        self.publisher_.publish(msg)
        self.count_ += 1


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
