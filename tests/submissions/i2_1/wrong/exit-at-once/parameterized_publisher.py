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
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)
        self.get_logger().info('ready')

    def tick(self):
        self.pub.publish(String(data=self.get_parameter('message_prefix').value))


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
