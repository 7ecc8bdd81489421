import time

import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__('stats')
        self.count = 0
        self.number = None
        self.sub = self.create_subscription(String, 'chatter', self.cb, 10)

    def cb(self, msg):
        if self.count == 0:
            self.first = msg.data
            self.start = time.time()
        self.count += 1
        self.last = msg.data
        number = int(msg.data.split(':')[1])
        if self.number is not None and number > self.number + 1:
            self.get_logger().warning(f'{number - self.number - 1} messages lost')
        self.number = number
        self.get_logger().info(f'got {msg.data}')
        self.process(msg)
        if self.count % 10 == 0:
            rate = self.count / (time.time() - self.start)
            self.get_logger().info(f'{self.count} msgs at {rate:.1f} Hz: {self.first} ... {self.last}')

    def process(self, msg):
        time.sleep(0.5)


def main():
    rclpy.init()
    node = Stats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
