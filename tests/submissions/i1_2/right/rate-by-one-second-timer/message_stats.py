import time
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

class Stats(Node):
    def __init__(self):
        super().__init__('stats')
        self.create_subscription(String, 'chatter', self.cb, 10)
        self.create_timer(1.0, self.tick)
        self.count = 0
        self.window = 0
        self.hz = 0.0
        self.first = ''
        self.seq = -1

    def tick(self):
        self.hz, self.window = float(self.window), 0

    def cb(self, msg):
        self.count += 1
        self.window += 1
        if self.count == 1:
            self.first = msg.data
        n = int(msg.data[len('Hello World: '):])
        if self.count > 1 and n - self.seq > 1:
            self.get_logger().warn('gap of ' + str(n - self.seq - 1))
        self.seq = n
        if self.count % 10 == 0:
            self.get_logger().info('count ' + str(self.count) + ' hz ' + str(self.hz) + ' first ' + self.first + ' last ' + msg.data)


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
