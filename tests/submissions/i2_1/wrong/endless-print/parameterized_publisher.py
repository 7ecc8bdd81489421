import rclpy
from rclpy.node import Node


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        while self.get_parameter('enabled').value:
            print(self.get_parameter('message_prefix').value)


rclpy.init()
rclpy.spin(ParameterizedPublisher())
