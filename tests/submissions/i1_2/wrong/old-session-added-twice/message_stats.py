#!/usr/bin/env python3
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.earlier = 0        # messages of the publishers before this one
        self.session = 0        # messages of this publisher
        self.first = None
        self.start = None
        self.prev = None
        self.create_subscription(String, '/chatter', self.callback, 10)

    @property
    def total(self):
        return self.earlier + self.session

    def callback(self, msg):
        n = int(msg.data.rsplit(None, 1)[1])
        if self.prev is not None:
            if n < self.prev:
                self.get_logger().info('new publisher on /chatter')
                self.earlier += self.session
            elif n > self.prev + 1:
                self.get_logger().warning(f'sequence gap: {self.prev} -> {n}')
        self.prev = n

        self.session += 1
        if self.first is None:
            self.first = msg.data
            self.start = time.time()
        if self.session % 10 == 0:
            self.get_logger().info(
                f'total: {self.total}, {self.total / (time.time() - self.start):.2f} msg/s, '
                f'first: "{self.first}", last: "{msg.data}"')


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
