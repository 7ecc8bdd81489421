import time
from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


@dataclass
class MessageStats:
    total_count: int = 0
    first_message: str = ''
    last_message: str = ''
    start_time: float = 0.0
    messages_per_second: float = 0.0


class StatsNode(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.stats = MessageStats()
        self.last_n = None
        self.subscription = self.create_subscription(String, '/chatter', self.listener_callback, 10)
        self.get_logger().info('Listening on /chatter')
        self.gap_subscription = self.create_subscription(String, '/chatter', self.listener_callback, 10)

    def listener_callback(self, msg):
        if self.stats.total_count == 0:
            self.stats.first_message = msg.data
            self.stats.start_time = time.time()
        self.stats.total_count += 1
        self.stats.last_message = msg.data
        elapsed = time.time() - self.stats.start_time
        if elapsed > 0:
            self.stats.messages_per_second = self.stats.total_count / elapsed
        n = int(msg.data.split(': ')[-1])
        if self.last_n is not None and n > self.last_n + 1:
            self.get_logger().warn(f'Gap detected: {self.last_n} -> {n}')
        self.last_n = n
        if self.stats.total_count % 10 == 0:
            s = self.stats
            self.get_logger().info(
                f'Total: {s.total_count}, rate: {s.messages_per_second:.2f}, '
                f'first: {s.first_message}, last: {s.last_message}'
            )


def main():
    rclpy.init()
    node = StatsNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
