#!/usr/bin/env python3
from typing import List

import rclpy
from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from std_msgs.msg import String


class ChatterPublisher(Node):
    """
    Publishes a prefix and a counter on /chatter. Everything can be retuned from rqt.
    """

    def __init__(self):
        super().__init__('parameterized_publisher')
        self.name = 'ChatterPublisher'

        # dyn params
        param_dicts = [
            {'name': 'message_prefix',
             'default': 'Hello',
             'descriptor': ParameterDescriptor(type=ParameterType.PARAMETER_STRING,
                                               description='start of each message')},
            {'name': 'publish_rate',
             'default': 5.0,
             'descriptor': ParameterDescriptor(type=ParameterType.PARAMETER_DOUBLE,
                                               description='rate of the main loop [Hz]')},
            {'name': 'enabled',
             'default': True,
             'descriptor': ParameterDescriptor(type=ParameterType.PARAMETER_BOOL,
                                               description='publish at all')},
        ]
        params = self.delcare_dyn_parameters(param_dicts)
        self.set_dyn_params(params)
        self.add_on_set_parameters_callback(self.dyn_param_cb)

        self.i = 0
        self.chatter_pub = self.create_publisher(String, 'chatter', QoSProfile(depth=10))
        self.main_timer = self.create_timer(1 / self.rate, self.loop)

    def delcare_dyn_parameters(self, param_dicts: List[dict]):
        params = []
        for param_dict in param_dicts:
            param = self.declare_parameter(
                param_dict['name'], param_dict['default'], param_dict['descriptor'])
            params.append(param)
        return params

    def set_dyn_params(self, params: List[Parameter]):
        for param in params:
            if param.name == 'message_prefix':
                self.prefix = param.value
            elif param.name == 'publish_rate':
                self.rate = param.value
            elif param.name == 'enabled':
                self.enabled = param.value

    # --- Callback functions ---

    def dyn_param_cb(self, params: List[Parameter]):
        for param in params:
            if param.name == 'publish_rate' and param.value <= 0.0:
                self.get_logger().warn(f'[{self.name}] refused publish_rate {param.value}')
                return SetParametersResult(
                    successful=False, reason='publish_rate has to be larger than 0')

        old_rate = self.rate
        self.set_dyn_params(params)
        if self.rate != old_rate:
            self.destroy_timer(self.main_timer)
            self.main_timer = self.create_timer(1 / self.rate, self.loop)
        self.get_logger().info(
            f'[{self.name}] new params: {self.prefix}, {self.rate}, {self.enabled}')
        return SetParametersResult(successful=True)

    def loop(self):
        if not self.enabled:
            return
        msg = String()
        msg.data = f'{self.prefix} {self.i}'
        self.chatter_pub.publish(msg)
        self.i += 1


def main(args=None):
    rclpy.init(args=args)
    node = ChatterPublisher()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
