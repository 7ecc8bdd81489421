#!/usr/bin/env python3
""" Publishes a string at a given rate. The interface class is kept apart from the node so that it can be
    run within another node as well.
"""

import rclpy
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class TalkParameters:
    """ Defines the default values of the talker """
    def __init__(self) -> None:
        self.message_prefix: str = "Hello"
        self.publish_rate: float = 1.0
        self.enabled: bool = True


class TalkInterface:
    """ Stores the state of the talker and publishes """

    def __init__(self, node: Node, talk_parameters: TalkParameters) -> None:
        self._node = node
        self._tp = talk_parameters
        self._count = 0
        self._talk_timer = None

        # Create the publisher
        self._pub_chatter = self._node.create_publisher(String, "chatter", 1)

        # Initialize the parameters
        self._node.declare_parameter(name="message_prefix", value=self._tp.message_prefix,
            descriptor=ParameterDescriptor(description="Text in front of the number"))
        self._tp.message_prefix = self._node.get_parameter(name="message_prefix").value
        self._node.declare_parameter(name="publish_rate", value=self._tp.publish_rate,
            descriptor=ParameterDescriptor(description="Rate at which the text is published (Hz)"))
        self._tp.publish_rate = self._node.get_parameter(name="publish_rate").value
        self._node.declare_parameter(name="enabled", value=self._tp.enabled,
            descriptor=ParameterDescriptor(description="True if text is to be published"))
        self._tp.enabled = self._node.get_parameter(name="enabled").value

    def initialize_callbacks(self) -> None:
        """ Initializes the callbacks for the parameters and the timer """
        self._node.add_on_set_parameters_callback(self.param_callback)
        self._talk_timer = self._node.create_timer(1.0/self._tp.publish_rate, self._talk_loop)

    def param_callback(self, params: list[Parameter]) -> SetParametersResult:
        """ Set all of the parameters that are passed in """
        for param in params:
            reason = self.process_param(param)
            if reason != "":
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def process_param(self, param: Parameter) -> str:
        """ Processes a single parameter. Returns why it could not be processed, "" if it could """
        if param.name == "publish_rate":
            if param.value > 0:
                # Destroy and recreate the timer
                self._node.destroy_timer(self._talk_timer)
                self._talk_timer = self._node.create_timer(1.0/param.value, self._talk_loop)
            else:
                reason = "rate not positive for setting parameter " + param.name
                self._node.get_logger().error(reason)
                return reason

        # Set the value
        setattr(self, "_tp." + param.name, param.value)
        return ""

    def _talk_loop(self) -> None:
        """ Creates and publishes the text """
        if not self._tp.enabled:
            return
        msg = String()
        msg.data = self._tp.message_prefix + " " + str(self._count)
        self._pub_chatter.publish(msg)
        self._count += 1


def main(args=None):
    rclpy.init(args=args)

    # Create the talker
    talk_node = rclpy.create_node(node_name="parameterized_publisher")
    talk_interface = TalkInterface(node=talk_node, talk_parameters=TalkParameters())
    talk_interface.initialize_callbacks()
    rclpy.spin(talk_node)

    # Shutdown the node
    talk_node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
