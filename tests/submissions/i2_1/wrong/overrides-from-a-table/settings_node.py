"""A node whose parameters are listed in the class."""

from rclpy.node import Node
from rclpy.parameter import Parameter


class SettingsNode(Node):
    SETTINGS = {}

    def __init__(self, name):
        given = [Parameter(key, value=value) for key, value in self.SETTINGS.items()]
        super().__init__(name, parameter_overrides=given)
        self.declare_parameters("", list(self.SETTINGS.items()))

    def setting(self, key):
        return self.get_parameter(key).value
