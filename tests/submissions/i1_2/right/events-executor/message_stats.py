import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.total = 0
        self.previous = None
        self.create_subscription(String, 'chatter', self.heard, 10)

    def heard(self, msg):
        self.total += 1
        if self.total == 1:
            self.first, self.began = msg.data, time.monotonic()
        number = int(msg.data.rsplit(' ', 1)[1])
        if self.previous is not None and number > self.previous + 1:
            self.get_logger().warning(f'jump in the sequence, {self.previous} to {number}')
        self.previous = number
        if self.total % 10 == 0:
            rate = self.total / (time.monotonic() - self.began)
            self.get_logger().info(f'[{self.total}] {self.first!r} .. {msg.data!r} at {rate:.2f}/s')


def main():
    rclpy.init()
    node = MessageStats()
    try:
        rclpy.spin(node, executor=EventsExecutor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
