#!/usr/bin/env python3
import time
from string import Template
from textwrap import dedent

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

REPORT = Template(dedent('''\
    ---
    statistics:
      total_count: $total
      messages_per_second: $rate
      average_period_ms: $period
      first_message: '$first'
      last_message: '$last'
      sequence_gaps: $gaps'''))


class Stats(Node):

    def __init__(self):
        super().__init__('message_stats')
        self.total = self.gaps = 0
        self.first = self.last = self.t0 = self.number = None
        self.create_subscription(String, 'chatter', self.callback, 10)

    def callback(self, msg):
        now = time.time()
        self.total += 1
        self.last = msg.data
        if self.first is None:
            self.first, self.t0 = msg.data, now

        number = int(msg.data.split(':')[-1])
        if self.number is not None and number - self.number > 1:
            self.gaps += 1
        self.number = number

        if self.total % 10 == 0:
            rate = (self.total - 1) / (now - self.t0)
            self.get_logger().info(REPORT.substitute(
                total=self.total, rate=round(rate, 3), period=round(1000 / rate, 1),
                first=self.first, last=self.last, gaps=self.gaps))


def main():
    rclpy.init()
    node = Stats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
