#!/usr/bin/env python3
import time
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class MessageStatsSubscriber(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.subscription = self.create_subscription(String, 'chatter', self.callback, 10)
        self.total_count = 0
        self.first_message = None
        self.last_message = None
        self.start_time = None
        self.expected = None
        self.get_logger().info('Statistics subscriber started')

    def callback(self, msg):
        if self.start_time is None:
            self.start_time = time.time()
            self.first_message = msg.data
        self.total_count += 1
        self.last_message = msg.data
        n = int(msg.data.split(': ')[1])
        if self.expected is not None and n != self.expected:
            self.get_logger().warn(f'Sequence gap: expected {self.expected}, got {n}')
        self.expected = n + 1
        if self.total_count % 10 == 0:
            elapsed = time.time() - self.start_time
            rate = self.total_count / elapsed if elapsed > 0 else 0
            self.get_logger().info(
                f'Stats: count={self.total_count}, '
                f'rate={rate:.2f} msg/s, '
                f'first="{self.first_message}", '
                f'last="{self.last_message}"')

def main():
    rclpy.init()
    node = MessageStatsSubscriber()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
