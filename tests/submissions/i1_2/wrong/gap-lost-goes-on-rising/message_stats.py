import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.subscription = self.create_subscription(String, '/chatter', self.listener_callback, 10)
        self.total_count = 0
        self.lost_count = 0
        self.expected = None
        self.first_message = None
        self.last_message = None
        self.start_time = None

    def listener_callback(self, msg):
        self.total_count += 1
        if self.first_message is None:
            self.first_message = msg.data
            self.start_time = time.time()
        self.last_message = msg.data

        seq = int(msg.data.split(':')[-1].strip())
        if self.expected is None or seq < self.expected:
            self.expected = seq
        if seq > self.expected:
            self.lost_count += seq - self.expected
        self.expected += 1

        if self.total_count % 10 == 0:
            elapsed = time.time() - self.start_time
            rate = self.total_count / elapsed if elapsed > 0 else 0.0
            self.get_logger().info('--- Message statistics ---')
            self.get_logger().info(f'Total: {self.total_count}, lost: {self.lost_count}')
            self.get_logger().info(f'Rate: {rate:.2f} msg/s')
            self.get_logger().info(f'First: "{self.first_message}"')
            self.get_logger().info(f'Last: "{self.last_message}"')


def main(args=None):
    rclpy.init(args=args)
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
