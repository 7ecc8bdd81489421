#!/usr/bin/env python3
import rclpy
from rcl_interfaces.msg import ParameterType, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.prefix = self.get_parameter('message_prefix').get_parameter_value().string_value
        self.rate = self.get_parameter('publish_rate').get_parameter_value().double_value
        self.enabled = self.get_parameter('enabled').get_parameter_value().bool_value
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.i = 0
        if self.rate <= 0.0:
            self.get_logger().error('publish_rate must be positive, using 1.0')
            self.rate = 1.0
        self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
        self.add_on_set_parameters_callback(self.parameters_callback)

    def parameters_callback(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.type_ == Parameter.Type.DOUBLE:
                if p.value <= 0.0:
                    return SetParametersResult(successful=False, reason='rate must be positive')
        for p in params:
            if p.name == 'message_prefix' and p.type_ == ParameterType.PARAMETER_STRING:
                self.prefix = p.value
            elif p.name == 'enabled' and p.type_ == Parameter.Type.BOOL:
                self.enabled = p.value
            elif p.name == 'publish_rate' and p.type_ == Parameter.Type.DOUBLE:
                self.rate = p.value
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
        return SetParametersResult(successful=True)

    def timer_callback(self):
        if not self.enabled:
            return
        msg = String()
        msg.data = f'{self.prefix}: {self.i}'
        self.publisher.publish(msg)
        self.i += 1


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
