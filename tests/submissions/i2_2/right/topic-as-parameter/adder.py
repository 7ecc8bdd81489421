import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Int32


class Adder(Node):
    def __init__(self):
        super().__init__('adder')
        topic = self.declare_parameter('topic_name', 'numbers').value
        self.total = 0
        self.create_subscription(Int32, topic, self.add, 10)

    def add(self, message):
        self.total += message.data
        self.get_logger().info('the sum is %d' % self.total)


def main():
    rclpy.init()
    try:
        rclpy.spin(Adder())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
