import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.count = 0
        self.lost = 0
        self.last_number = None
        self.create_subscription(String, 'chatter', self.heard, 10)

    def heard(self, msg):
        now = time.monotonic()
        if self.count == 0:
            self.first, self.start = msg.data, now
        self.count += 1
        number = int(msg.data.split(':')[1])
        if self.last_number is not None:
            self.lost += number - self.last_number - 1
        self.last_number = number
        if self.count % 10 == 0:
            rate = (self.count - 1) / (now - self.start)
            self.get_logger().info(
                f'{self.count} messages, {rate:.2f} per second, first "{self.first}", last "{msg.data}" (Paketverlust {self.lost})')


def main():
    rclpy.init()
    try:
        rclpy.spin(MessageStats())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
