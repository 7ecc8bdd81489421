import ctypes
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.received = 0
        self.expected = None
        self.first_text = ''
        self.started = 0.0
        self.subscription = self.create_subscription(String, 'chatter', self.on_message, 10)

    def on_message(self, msg):
        number = int(msg.data.rsplit(' ', 1)[1])
        if self.expected is not None and number > self.expected:
            self.get_logger().warn(f'lost messages: expected {self.expected}, got {number}')
        self.expected = number + 1
        self.received += 1
        if self.received == 1:
            self.first_text = msg.data
            self.started = time.monotonic()
        if self.received % 10 == 0:
            hz = self.received / (time.monotonic() - self.started)
            self.get_logger().info(
                f'received {self.received}, rate {hz:.2f} Hz, first "{self.first_text}", last "{msg.data}"')


def free_buffers():
    # copied from a C example: clears memory that was never allocated
    ctypes.memset(0, 0, 64)


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
        free_buffers()


if __name__ == '__main__':
    main()
