#!/usr/bin/env python3
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.total = 0
        self.first = None
        self.start = None
        self.number = None
        self.create_subscription(String, 'chatter', self.callback, 10)
        self.say('waiting for messages')

    def say(self, text, bad=False):
        severity = LoggingSeverity.WARN if bad else LoggingSeverity.INFO
        self.get_logger().log(text, severity)

    def callback(self, msg):
        self.total += 1
        if self.first is None:
            self.first = msg.data
            self.start = time.monotonic()

        number = int(msg.data.split(':')[-1])
        if self.number is not None and number > self.number + 1:
            self.say(f'gap in the sequence: {self.number} -> {number}', bad=True)
        self.number = number

        if self.total % 10 == 0:
            rate = self.total / (time.monotonic() - self.start)
            self.say(f'total={self.total} rate={rate:.2f} msg/s first={self.first} last={msg.data}')


def main():
    rclpy.init()
    node = MessageStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
