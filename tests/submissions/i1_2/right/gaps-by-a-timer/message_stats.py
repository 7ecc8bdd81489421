import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__('stats')
        self.count = 0
        self.lost = 0
        self.number = None
        self.create_subscription(String, 'chatter', self.on_message, 10)
        self.create_timer(1.0, self.report_gaps)

    def on_message(self, msg):
        number = int(msg.data.split(': ')[1])
        if self.number is not None and number > self.number:
            self.lost += number - self.number - 1
        self.number = number
        if self.count == 0:
            self.first, self.start = msg.data, time.time()
        self.count += 1
        if self.count % 10 == 0:
            rate = self.count / (time.time() - self.start)
            self.get_logger().info(f'{self.count} messages, {rate:.2f}/s, first {self.first}, last {msg.data}')

    def report_gaps(self):
        if self.lost:
            self.get_logger().error(f'{self.lost} lost in the last second')
            self.lost = 0


def main():
    rclpy.init()
    try:
        rclpy.spin(Stats())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
