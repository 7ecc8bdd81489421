import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.last = None
        self.prev = None
        self.reset()
        self.create_subscription(String, 'chatter', self.cb, 10)

    def reset(self):
        self.total, self.first, self.t0 = 0, None, None

    def cb(self, msg):
        now = time.monotonic()
        n = int(msg.data.split(':')[1])
        if self.prev is not None and n > self.prev + 1:
            self.get_logger().warning('GAP!')
            self.get_logger().warning(f'  last: {self.last}')
            self.get_logger().warning(f'  now:  {msg.data}')
        elif self.prev is not None and n <= self.prev:
            self.get_logger().warning(f'Restart detected ({self.last} -> {msg.data}): statistics reset')
            self.reset()
        self.prev = n
        if self.total == 0:
            self.t0, self.first = now, msg.data
        self.total += 1
        self.last = msg.data
        if self.total % 10 == 0:
            rate = (self.total - 1) / (now - self.t0)
            self.get_logger().info(f'total={self.total} rate={rate:.2f}/s first="{self.first}" last="{self.last}"')


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
