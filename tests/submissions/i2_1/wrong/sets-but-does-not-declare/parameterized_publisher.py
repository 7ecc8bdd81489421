#!/usr/bin/env python3
# ported from our dashing node, no declare needed with allow_undeclared_parameters
import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter

from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


class ParameterizedPublisher(Node):

    def __init__(self):
        super().__init__('parameterized_publisher', allow_undeclared_parameters=True)

        my_prefix = Parameter('message_prefix', Parameter.Type.STRING, 'Hello')
        my_rate = Parameter('publish_rate', Parameter.Type.DOUBLE, 1.0)
        my_enabled = Parameter('enabled', Parameter.Type.BOOL, True)
        self.set_parameters([my_prefix, my_rate, my_enabled])

        self.pub = self.create_publisher(String, 'chatter', 10)
        self.i = 0
        self.tmr = self.create_timer(1.0 / self.get_parameter('publish_rate').value,
                                     self.timer_callback)
        self.add_on_set_parameters_callback(self.parameters_callback)

    def parameters_callback(self, parameter_list):
        for param in parameter_list:
            if param.name == 'publish_rate':
                if param.type_ not in (Parameter.Type.DOUBLE, Parameter.Type.INTEGER):
                    return SetParametersResult(successful=False, reason='publish_rate has to be a number')
                if param.value <= 0:
                    return SetParametersResult(successful=False, reason='publish_rate has to be > 0')
                self.destroy_timer(self.tmr)
                self.tmr = self.create_timer(1.0 / param.value, self.timer_callback)
        return SetParametersResult(successful=True)

    def timer_callback(self):
        if self.get_parameter('enabled').value is not True:
            return
        msg = String()
        msg.data = '{0}: {1}'.format(self.get_parameter('message_prefix').value, self.i)
        self.i += 1
        self.get_logger().info('Publishing: "{0}"'.format(msg.data))
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)

    node = ParameterizedPublisher()

    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass

    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
