#!/usr/bin/env python3
# based on my gpio_button_node.py (rpi4, humble)
import re
import time
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

TOPIC = '/chatter'
DEBOUNCE_S = 0.05   # ignore bouncing


class Edge:
    """remembers when the last event was let through"""
    def __init__(self, hold):
        self.hold = hold
        self.t = 0.0

    def accept(self):
        t = time.time()
        if t - self.t < self.hold:
            return False
        self.t = t
        return True


class MessageStatsNode(Node):
    def __init__(self):
        super().__init__('message_stats_node')
        self.edge = Edge(DEBOUNCE_S)
        self.cnt = 0
        self.first = ''
        self.last = ''
        self.t_first = 0.0
        self.seq = -1
        self.sub = self.create_subscription(String, TOPIC, self.cb, 10)
        self.get_logger().info('up, waiting on ' + TOPIC)

    def check_seq(self, txt):
        m = re.search(r'(\d+)\s*$', txt)
        if not m:
            return
        n = int(m.group(1))
        if self.seq >= 0 and n > self.seq + 1:
            self.get_logger().warn('GAP: missed %d messages before #%d' % (n - self.seq - 1, n))
        elif self.seq >= 0 and n <= self.seq:
            self.get_logger().warn('talker restarted (#%d after #%d)' % (n, self.seq))
        self.seq = n

    def cb(self, msg):
        self.check_seq(msg.data)
        if not self.edge.accept():
            return
        if self.cnt == 0:
            self.first = msg.data
            self.t_first = time.time()
        self.cnt += 1
        self.last = msg.data
        if self.cnt % 10 == 0:
            dt = time.time() - self.t_first
            self.get_logger().info('--- stats: n=%d  %.2f msg/s  first=[%s]  last=[%s]' % (
                self.cnt, self.cnt / dt, self.first, self.last))


def main():
    rclpy.init()
    n = MessageStatsNode()
    try:
        rclpy.spin(n)
    except KeyboardInterrupt:
        print('bye')
    finally:
        n.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
