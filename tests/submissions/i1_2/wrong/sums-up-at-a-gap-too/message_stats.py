import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.total = 0
        self.first = None
        self.t0 = None
        self.prev = None
        self.create_subscription(String, 'chatter', self.cb, 10)

    def cb(self, msg):
        now = time.monotonic()
        n = int(msg.data.split(':')[1])
        gap = self.prev is not None and n > self.prev + 1
        if gap:
            self.get_logger().warning(f'gap: {n - self.prev - 1} messages lost between #{self.prev} and #{n}')
        self.prev = n
        if self.total == 0:
            self.t0, self.first = now, msg.data
        self.total += 1
        if self.total % 10 == 0 or gap:
            rate = (self.total - 1) / (now - self.t0)
            self.get_logger().info(f'total={self.total} rate={rate:.2f} first="{self.first}" last="{msg.data}"')


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
