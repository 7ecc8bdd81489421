import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.pub = self.create_publisher(String, 'chatter', 10)


def main():
    rclpy.init()
    rclpy.spin(ParameterizedPublisher())


if __name__ == 'main':
    main()
