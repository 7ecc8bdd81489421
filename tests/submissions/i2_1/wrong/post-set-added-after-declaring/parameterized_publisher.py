#! /usr/bin/env python3

"""
Description:
This ROS2 node periodically publishes a user specified prefix and a counter.
---
Publishes to: /chatter (std_msgs/msg/String)
---
Subscribes to: None
---
Parameters:
message_prefix (string, "Hello"), publish_rate (double, 1.0 Hz), enabled (bool, true)
---
Usage Example:
-> python3 parameterized_publisher.py --ros-args -p message_prefix:="I'm BATMAN"
---
"""

import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult


class ParameterizedPublisher(Node):

    def __init__(self):

        # call the node class constructor with the node name
        super().__init__("parameterized_publisher")

        # members, the post set callback updates them with every parameter that gets set
        self._message_prefix = 'Hello'
        self._publish_rate = 1.0
        self._enabled = True
        self._i = 0

        # create a publisher obj
        self._publisher = self.create_publisher(String, "chatter", 10)

        # declare params
        self.declare_parameter('message_prefix', 'Hello',
                               ParameterDescriptor(description="Start of every message."))
        self.declare_parameter('publish_rate', 1.0,  # data type matters 1 != 1.0
                               ParameterDescriptor(description="Messages per second."))
        self.declare_parameter('enabled', True,
                               ParameterDescriptor(description="Publish or be quiet."))

        # configure callbacks for parameter update
        self.add_on_set_parameters_callback(self._on_set_parameter_callback)
        self.add_post_set_parameters_callback(self._post_set_parameter_callback)

        # periodically call method
        self._timer = self.create_timer(1.0 / self._publish_rate, self._timer_callback)

    def _timer_callback(self):

        if not self._enabled:
            return

        msg = String()
        msg.data = f'{self._message_prefix} {self._i}'
        self._i += 1

        self._publisher.publish(msg)

        self.get_logger().info(f'Publishing: "{msg.data}"')

    def _on_set_parameter_callback(self, parameter_list):
        for param in parameter_list:
            if param.name == "publish_rate" and param.value <= 0.0:
                return SetParametersResult(successful=False,
                                           reason="publish_rate must be greater than zero")
        return SetParametersResult(successful=True)

    def _post_set_parameter_callback(self, parameter_list):
        for param in parameter_list:
            if param.name == "message_prefix":
                self._message_prefix = param.value
            elif param.name == "enabled":
                self._enabled = param.value
            elif param.name == "publish_rate":
                self._publish_rate = param.value
                # reset timer
                self._timer.cancel()
                self.destroy_timer(self._timer)
                self._timer = self.create_timer(1.0 / self._publish_rate, self._timer_callback)
            self.get_logger().info(f"Updated {param.name} to {param.value}")


def main(args=None):

    node = None  # guarantees finally can always safely reference it

    try:
        rclpy.init(args=args)
        node = ParameterizedPublisher()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        print()
    finally:
        if node is not None:
            node.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()


if __name__ == "__main__":
    main()
