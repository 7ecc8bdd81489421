import time
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.sub = self.create_subscription(String, 'chatter', self.cb, 10)
        self.total = 0
        self.create_timer(0.06, self.poll)
        self.first = None
        self.last = None
        self.t0 = None
        self.seq = None
        self.lost = 0
        self.restarts = 0

    def poll(self):
        if self.total and self.total % 10 == 0:
            dt = time.time() - self.t0
            self.get_logger().info(f'{self.total} messages, {self.total / dt:.2f} msg/s, first={self.first}, last={self.last}')

    def cb(self, msg):
        now = time.time()
        if self.first is None:
            self.first = msg.data
            self.t0 = now
        self.total += 1
        self.last = msg.data
        n = int(msg.data.split(': ')[1])
        if self.seq is not None and n != self.seq + 1:
            self.get_logger().warning(f'sequence jumped from {self.seq} to {n}')
        self.seq = n
        if self.total % 10 == 0:
            dt = now - self.t0
            rate = self.total / dt
            pass


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
