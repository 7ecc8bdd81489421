#!/usr/bin/env python3
import logging
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):

    def __init__(self):
        super().__init__('message_stats')
        self.history = []          # (time, text) of the current ten
        self.total = 0
        self.first = None
        self.t_first = None
        self.seq = None
        self.subscription = self.create_subscription(String, '/chatter', self.on_msg, 10)
        self.say('info', 'ready')

    def say(self, level, text):
        """One place for all log output, so that it can be switched off for the unit tests."""
        if logging.root.disabled:
            return
        getattr(self.get_logger(), level)('[message_stats] ' + text)

    def on_msg(self, msg):
        now = time.time()
        self.total += 1
        if self.first is None:
            self.first, self.t_first = msg.data, now
        self.history.append((now, msg.data))
        self.sequence_check(int(msg.data.split(': ')[-1]))
        if len(self.history) == 10:
            self.summary()
            self.history.clear()

    def sequence_check(self, seq):
        if self.seq is not None:
            diff = seq - self.seq
            if diff > 1:
                self.say('warning', 'gap of %d messages before %d' % (diff - 1, seq))
            elif diff < 1:
                self.say('info', 'publisher restarted at %d' % seq)
        self.seq = seq

    def summary(self):
        t, text = self.history[-1]
        self.say('info', 'total {} messages, {:.2f} msg/s, first "{}", last "{}"'.format(
            self.total, self.total / (t - self.t_first), self.first, text))


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
