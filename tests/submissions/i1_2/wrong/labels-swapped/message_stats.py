import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.total_count = 0
        self.first_message = None
        self.last_seq = None
        self.start_time = None
        self.sub = self.create_subscription(String, '/chatter', self.callback, 10)

    def callback(self, msg):
        now = time.monotonic()
        if self.first_message is None:
            self.first_message, self.start_time = msg.data, now
        self.total_count += 1
        n = int(msg.data.split(':')[1])
        if self.last_seq is not None:
            if n > self.last_seq + 1:
                self.get_logger().warning(f'Lost {n - self.last_seq - 1} message(s), sequence is now at {n}')
            elif n <= self.last_seq:
                self.get_logger().warning('Publisher came back, counting on')
        self.last_seq = n
        if self.total_count % 10 == 0:
            rate = self.total_count / (now - self.start_time)
            self.get_logger().info(
                f'Total messages: {self.total_count} | Rate: {rate:.2f} msgs/sec | '
                f'First: "{msg.data}" | Last: "{self.first_message}"')


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
