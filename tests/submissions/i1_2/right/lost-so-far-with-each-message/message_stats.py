import time
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

class Stats(Node):
    def __init__(self):
        super().__init__('stats')
        self.create_subscription(String, '/chatter', self.on, 10)
        self.c = 0
        self.lost = 0
        self.prev = None

    def on(self, m):
        t = time.monotonic()
        if self.c == 0:
            self.f, self.t0 = m.data, t
        self.c += 1
        i = int(m.data.rsplit(' ', 1)[-1])
        if self.prev is not None and i > self.prev + 1:
            self.lost += i - self.prev - 1
        self.prev = i
        self.get_logger().info(f'[{self.c}] {m.data} (lost so far: {self.lost})')
        if self.c % 10 == 0:
            self.get_logger().info(f'SUMMARY total {self.c}, {(self.c - 1) / (t - self.t0):.2f} per second, from "{self.f}" to "{m.data}"')


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
