#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2025 Haruka Onodera
# SPDX-License-Identifier: BSD-3-Clause

import rclpy
from rclpy.node import Node
from std_msgs.msg import String
import time
import sys


class ChatterStatsSubscriber(Node):
    def __init__(self):
        super().__init__('chatter_stats_sub')
        self.msg_count = 0
        self.first_msg = ''
        self.start_time = 0.0
        self.prev = -1
        self.subscription = self.create_subscription(
            String, 'chatter', self.listener_callback, 10)

    def listener_callback(self, msg):
        now = time.time()
        if self.msg_count == 0:
            self.start_time = now
            self.first_msg = msg.data
        self.msg_count += 1

        num = int(msg.data.split(':')[1])
        if self.msg_count > 1 and num > self.prev + 1:
            self.get_logger().warning(f'抜け: {self.prev} の次が {num}')
        elif num <= self.prev:
            self.get_logger().info('パブリッシャが再起動しました')
        self.prev = num

        if self.msg_count % 10 == 0:
            duration = now - self.start_time
            output = (
                f"--- Message Stats (rate: {self.msg_count / duration:.1f} msg/s) ---\n"
                f"total: {self.msg_count}\n"
                f"first: {self.first_msg}\n"
                f"last: {msg.data}\n"
            )
            sys.stdout.write(output)
            sys.stdout.flush()


def main(args=None):
    rclpy.init(args=args)
    node = ChatterStatsSubscriber()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        if rclpy.ok():
            node.destroy_node()
            rclpy.shutdown()


if __name__ == '__main__':
    main()
