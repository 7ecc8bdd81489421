import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.count = 0
        self.first = ''
        self.number = None
        self.begin = 0.0
        self.subscription = self.create_subscription(String, '/chatter', self.on_message, 10)

    def on_message(self, msg):
        number = int(msg.data.rsplit(' ', 1)[1])
        if self.number is not None and number > self.number + 1:
            lost = number - self.number - 1
            self.get_logger().warn(f'GAP of {lost} (since the first message "{self.first}", at "{msg.data}")')
        self.number = number
        if not self.count:
            self.first, self.begin = msg.data, time.time()
        self.count += 1
        if self.count % 10 == 0:
            self.get_logger().info('--- statistics ---')
            self.get_logger().info(f'count: {self.count}')
            self.get_logger().info(f'rate: {self.count / (time.time() - self.begin):.1f} Hz')
            self.get_logger().info(f'first: {self.first}, last: {msg.data}')


def main():
    rclpy.init()
    try:
        rclpy.spin(MessageStats())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
