#! /usr/bin/env python3
# -*- coding: utf-8 -*-

"""
parameterized_publisher.py: publish a string, all settings can be changed from the command line.
"""

import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    PARAMS_DICT = {
        "message_prefix": (Parameter.Type.STRING, "Hello"),
        "publish_rate": (Parameter.Type.DOUBLE, 1.0),
        "enabled": (Parameter.Type.BOOL, True),
    }

    def __init__(self, name="parameterized_publisher"):
        super().__init__(name)
        self.name = name

        self.publisher_chatter = self.create_publisher(String, "chatter", 10)
        self.timer = None
        self.idx = 0

        # create ROS parameters that can be changed from command line.
        for key, (_, value) in self.PARAMS_DICT.items():
            self.declare_parameter(key, value)

        self.add_on_set_parameters_callback(self.set_params)

        # need to do this so that the callback fills in our attributes
        # and starts the timer.
        parameters = [
            Parameter(key, type_, value)
            for key, (type_, value) in self.PARAMS_DICT.items()
        ]
        self.set_parameters(parameters)

    def set_params(self, params):
        for param in params:
            if param.name == "publish_rate" and param.value <= 0:
                return SetParametersResult(
                    successful=False, reason=f"invalid publish_rate {param.value}, needs to be > 0"
                )

        for param in params:
            if param.name == "message_prefix":
                self.message_prefix = param.value
            elif param.name == "enabled":
                self.enabled = param.value
            elif param.name == "publish_rate":
                self.publish_rate = param.value
                if self.timer is not None:
                    self.destroy_timer(self.timer)
                self.timer = self.create_timer(1 / self.publish_rate, self.publish)
            self.get_logger().info(f"changed {param.name} to {param.value}")
        return SetParametersResult(successful=True)

    def publish(self):
        if not self.enabled:
            return
        self.publisher_chatter.publish(String(data=f"{self.message_prefix} {self.idx}"))
        self.idx += 1


def main(args=None):
    rclpy.init(args=args)
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        print("Stopping")
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
