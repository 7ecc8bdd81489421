#!/usr/bin/env python3
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.total = 0
        self.first = None
        self.t0 = None
        self.create_subscription(String, 'chatter', self.callback, 10)

    def callback(self, msg):
        if self.first is None:
            self.first, self.t0 = msg.data, time.time()
        self.total += 1
        if self.total % 10 == 0:
            rate = self.total / (time.time() - self.t0)
            self.get_logger().info(
                f'Summary: {self.total} messages, {rate:.2f} msg/s, '
                f'first "{self.first}", last "{msg.data}"')
            self.get_logger().warning(
                'Gap in the sequence detected or publisher restarted: messages may have been lost')


def main():
    rclpy.init()
    node = MessageStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
