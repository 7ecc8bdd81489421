#!/usr/bin/env python3
import time
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.total = 0
        self.first = None
        self.last = None
        self.t0 = None
        self.prev = None
        self.lost = 0
        self.rate = 0.0
        self.pending=[]; self.create_timer(1.0,self.flush)
        self.sub = self.create_subscription(String, 'chatter', self.cb, 10)

    def cb(self, msg):
        now = time.monotonic()
        n = int(msg.data.split(':')[1])
        if self.prev is not None and n > self.prev + 1:
            self.lost += n - self.prev - 1
            self.get_logger().warning(f'Gap: {n - self.prev - 1} messages lost between #{self.prev} and #{n}')
        elif self.prev is not None and n <= self.prev:
            self.get_logger().info(f'Publisher restarted')
        self.prev = n
        if self.total == 0:
            self.t0 = now
            self.first = msg.data
        self.total += 1
        self.last = msg.data
        if self.total % 10 == 0:
            el = now - self.t0
            self.rate = (self.total - 1) / el if el > 0 else 0.0
            self.pending.append(f'Stats: total={self.total} rate={self.rate:.2f} msg/s first="{self.first}" last="{self.last}"')
    def flush(self):
        while self.pending: self.get_logger().info(self.pending.pop(0))

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
