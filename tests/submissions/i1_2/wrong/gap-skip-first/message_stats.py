import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.total = 0
        self.first = None
        self.last = None
        self.t0 = None
        self.expected = None
        self.create_subscription(String, 'chatter', self.callback, 10)

    def callback(self, msg):
        now = time.time()
        number = int(msg.data.split()[-1])
        if self.expected is not None and number > self.expected:
            # the first one is always a false alarm, when the node has just been started
            self.get_logger().warning(f'gap: expected {self.expected}, got {number}', skip_first=True)
        elif self.expected is not None and number < self.expected:
            self.get_logger().info('the publisher was restarted')
        self.expected = number + 1

        if self.t0 is None:
            self.t0 = now
            self.first = msg.data
        self.total += 1
        self.last = msg.data
        if self.total % 10 == 0:
            self.get_logger().info(
                f'{self.total} messages, {self.total / (now - self.t0):.2f} msg/s, '
                f'first "{self.first}", last "{self.last}"')


def main():
    rclpy.init()
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
