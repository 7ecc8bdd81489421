#! /usr/bin/env python3
# -*- coding: utf-8 -*-

"""
parameterized_publisher.py: publish text, parameters can be changed from command line.
"""

import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult

from std_msgs.msg import String

PREFIX = "Hello"
PUBLISH_RATE = 1.0  # Hz


class ParameterizedPublisher(Node):
    def __init__(self, name="parameterized_publisher", publish_rate=PUBLISH_RATE):
        super().__init__(name)
        self.name = name

        self.publisher_text = self.create_publisher(String, "chatter", 10)

        # create ROS parameters that can be changed from command line.
        # (numbers are kept as text so that expressions such as 44100/2048 work)
        self.declare_parameter("message_prefix", PREFIX)
        self.declare_parameter("publish_rate", str(publish_rate))
        self.declare_parameter("enabled", True)

        self.publish_rate = eval(
            self.get_parameter("publish_rate").get_parameter_value().string_value
        )
        self.add_on_set_parameters_callback(self.set_params)

        self.msg_idx = 0
        self.start_time = time.time()
        self.timer = self.create_timer(1 / self.publish_rate, self.publish_text)

    def set_params(self, params):
        for param in params:
            if param.name == "publish_rate":
                new_value = eval(param.get_parameter_value().string_value)
                if new_value <= 0:
                    return SetParametersResult(
                        successful=False, reason=f"publish_rate {new_value} is not positive"
                    )
                self.publish_rate = new_value
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1 / self.publish_rate, self.publish_text)
            self.get_logger().info(f"changing {param.name} to {param.value}")
        return SetParametersResult(successful=True)

    def get_time_ms(self):
        return int(1000 * (time.time() - self.start_time))

    def publish_text(self):
        if not self.get_parameter("enabled").value:
            return
        prefix = self.get_parameter("message_prefix").value
        msg = String(data=f"{prefix} {self.msg_idx} ({self.get_time_ms()} ms)")
        self.publisher_text.publish(msg)
        self.msg_idx += 1


def main(args=None):
    rclpy.init(args=args)
    publisher = ParameterizedPublisher()
    try:
        rclpy.spin(publisher)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    publisher.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
