import time
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

class Stats(Node):
    """When the publisher comes back, the old session is summed up and a new one begins."""
    def __init__(self):
        super().__init__('session_stats')
        self.create_subscription(String, 'chatter', self.cb, 10)
        self.last_n = None
        self.reset()

    def reset(self):
        self.count, self.first, self.last, self.start = 0, None, None, None

    def summary(self, title):
        dt = time.time() - self.start
        self.get_logger().info(f'{title}: total={self.count} rate={self.count / dt if dt else 0.0:.2f} first="{self.first}" last="{self.last}"')

    def cb(self, msg):
        n = int(msg.data.split(':')[1])
        if self.last_n is not None and n < self.last_n:
            self.get_logger().warn('publisher restarted - starting a new session')
            self.summary('old session')
            self.reset()
        elif self.last_n is not None and n > self.last_n + 1:
            self.get_logger().warn(f'gap: {self.last_n} -> {n}')
        self.last_n = n
        if self.start is None:
            self.start, self.first = time.time(), msg.data
        self.count += 1
        self.last = msg.data
        if self.count % 10 == 0:
            self.summary('statistics')


def main(args=None):
    rclpy.init(args=args)
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
