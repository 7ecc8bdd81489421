import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.prefix = self.get_parameter('message_prefix').value
        self.rate = self.get_parameter('publish_rate').value
        self.enabled = self.get_parameter('enabled').value
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
        self.count = 0

    def timer_callback(self):
        if self.enabled:
            self.publisher.publish(String(data=f'{self.prefix} {self.count}'))
            self.count += 1


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
