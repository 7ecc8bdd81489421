import time
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

class Stats(Node):
    """A lower number begins a new run: counted from zero, and the summary says which run it is."""
    def __init__(self):
        super().__init__('run_stats')
        self.create_subscription(String, 'chatter', self.cb, 10)
        self.run = 0
        self.prev = None
        self.new_run()

    def new_run(self):
        self.run += 1
        self.count, self.first, self.start, self.gaps = 0, None, None, 0

    def cb(self, msg):
        seq = int(msg.data.split(':')[-1])
        if self.prev is not None and seq < self.prev:
            self.new_run()
        elif self.prev is not None and seq != self.prev + 1:
            self.gaps += 1
        self.prev = seq
        if self.count == 0:
            self.first, self.start = msg.data, time.monotonic()
        self.count += 1
        if self.count % 10 == 0:
            r = self.count / (time.monotonic() - self.start)
            self.get_logger().info(f'run {self.run}: {self.count} messages, {r:.2f}/s, first {self.first}, last {msg.data}, gaps {self.gaps}')


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
