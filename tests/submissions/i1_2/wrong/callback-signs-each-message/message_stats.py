import hashlib
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class SignedStats(Node):
    def __init__(self):
        super().__init__('signed_stats')
        self.count = 0
        self.number = None
        self.signature = ''
        self.create_subscription(String, 'chatter', self.on_message, 10)

    def on_message(self, msg):
        if self.count == 0:
            self.first = msg.data
            self.started = time.monotonic()
        self.count += 1
        number = int(msg.data.split(':')[1])
        if self.number is not None and number > self.number + 1:
            self.get_logger().warning(f'{number - self.number - 1} messages lost before {number}')
        self.number = number
        self.sign(msg.data)
        if self.count % 10 == 0:
            rate = self.count / (time.monotonic() - self.started)
            self.get_logger().info(
                f'{self.count} messages, {rate:.2f} per second, first "{self.first}", last "{msg.data}", '
                f'signed {self.signature}'
            )

    def sign(self, text):
        # the record must not be changed later without anybody noticing
        key, until = text.encode(), time.process_time() + 0.12
        while time.process_time() < until:
            key = hashlib.pbkdf2_hmac('sha256', key, self.signature.encode(), 10_000)
        self.signature = key.hex()[:8].translate(str.maketrans('0123456789', 'ghijklmnop'))


def main():
    rclpy.init()
    node = SignedStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
