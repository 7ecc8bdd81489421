import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.count = 0
        self.first = None
        self.previous = None
        self.begin = 0.0
        self.hz = None
        self.create_subscription(String, '/chatter', self.on_message, 10)

    def on_message(self, msg):
        if self.count == 0:
            self.first, self.begin = msg.data, time.monotonic()
        self.count += 1
        number = int(msg.data.split(': ')[1])
        if self.previous is not None and number > self.previous + 1:
            self.get_logger().warning(f'{number - self.previous - 1} messages missing before {number}')
        self.previous = number
        if self.count % 10 == 0:
            if self.hz is None:  # the talker is steady, so once is enough
                self.hz = (self.count - 1) / (time.monotonic() - self.begin)
            self.get_logger().info(f'{self.count} messages, {self.hz:.2f} Hz, from "{self.first}" to "{msg.data}"')


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
