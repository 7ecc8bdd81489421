import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Hearer(Node):
    def __init__(self):
        super().__init__('hearer')
        self.create_subscription(String, 'chatter', self.hear, 10)

    def hear(self, message):
        self.get_logger().info('heard ' + message.text)


def main():
    rclpy.init()
    rclpy.spin(Hearer())
