import rclpy
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        for p in params:
            if p.name = 'publish_rate':
                self.rate = p.value
        return SetParametersResult(successful=True)


rclpy.init()
rclpy.spin(ParameterizedPublisher())
