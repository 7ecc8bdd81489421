#! /usr/bin/env python
# -*- coding: utf-8 -*-

import rclpy
from rclpy.exceptions import ROSInterruptException
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult

from std_msgs.msg import String


class TalkerNode(Node):

    def __init__(self):
        super().__init__("parameterized_publisher")
        self.node_name = self.get_name()

        self.get_node_parameter()

        self.pub = self.create_publisher(String, "talker", 10)
        self.get_logger().info("{0} started".format(self.node_name))

        self.rate = self.create_rate(self.parameters["publish_rate"])
        self.add_on_set_parameters_callback(self.paramCallback)
        self.seq = 0

        # start the loop once the node is spinning
        self.timer = self.create_timer(1.0, self.run)

    def get_node_parameter(self):
        self.parameters = {
            "message_prefix": "Hello",
            "publish_rate": 1.0,
            "enabled": True,
        }

        for key in self.parameters.keys():
            self.declare_parameter(key, self.parameters[key])
            self.parameters[key] = self.get_parameter(key).value
            self.get_logger().info(
                "ros2 parameter, {0}: {1}".format(key, self.parameters[key]))

    def paramCallback(self, params):
        for param in params:
            if param.name == "publish_rate" and param.value <= 0:
                return SetParametersResult(
                    successful=False, reason="publish_rate must be positive")
        for param in params:
            self.parameters[param.name] = param.value
            if param.name == "publish_rate":
                self.destroy_rate(self.rate)
                self.rate = self.create_rate(param.value)
        return SetParametersResult(successful=True)

    def run(self):
        self.timer.cancel()
        while rclpy.ok():
            if self.parameters["enabled"]:
                self.publish()
            self.rate.sleep()

    def publish(self):
        msg = String()
        msg.data = "%s %d" % (self.parameters["message_prefix"], self.seq)
        self.pub.publish(msg)
        self.seq += 1


def main(args=None):
    rclpy.init(args=args)
    node = TalkerNode()
    try:
        rclpy.spin(node)
    except (ROSInterruptException, ExternalShutdownException, KeyboardInterrupt):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
