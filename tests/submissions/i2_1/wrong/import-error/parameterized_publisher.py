import rclpy
from rclpy.node import Node
from rclpy.parameter import SetParametersResult
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.add_on_set_parameters_callback(lambda params: SetParametersResult(successful=True))


rclpy.init()
rclpy.spin(ParameterizedPublisher())
