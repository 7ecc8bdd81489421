#!/usr/bin/env python3
# I wanted to keep the callback short, so the printing is done in a timer.
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

SUMMARY_EVERY = 10


class StatsNode(Node):

    def __init__(self):
        super().__init__('message_stats')
        self.total_count = 0
        self.first_message = None
        self.last_message = None
        self.start_time = None
        self.messages_per_second = 0.0
        self.last_n = None

        self.sub = self.create_subscription(String, '/chatter', self.chatter_cb, 10)
        # look 20 times a second if there is something to print
        self.print_timer = self.create_timer(0.05, self.print_cb)

    def chatter_cb(self, msg):
        t = time.time()
        if self.first_message is None:
            self.first_message = msg.data
            self.start_time = t
        self.total_count = self.total_count + 1
        self.last_message = msg.data
        if t > self.start_time:
            self.messages_per_second = self.total_count / (t - self.start_time)

        # gaps
        try:
            n = int(msg.data.split(': ')[1])
        except (IndexError, ValueError):
            self.get_logger().info('strange message: ' + msg.data)
            return
        if self.last_n is not None and n < self.last_n:
            self.get_logger().info('new talker')
        elif self.last_n is not None and n != self.last_n + 1:
            self.get_logger().warning('jump from %d to %d' % (self.last_n, n))
        self.last_n = n

    def print_cb(self):
        if self.total_count == 0:
            return
        if self.total_count % SUMMARY_EVERY == 0:
            self.get_logger().info(
                'SUMMARY total=%d rate=%.2f first="%s" last="%s"' %
                (self.total_count, self.messages_per_second,
                 self.first_message, self.last_message))


def main(args=None):
    rclpy.init(args=args)
    stats = StatsNode()
    try:
        rclpy.spin(stats)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        stats.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
