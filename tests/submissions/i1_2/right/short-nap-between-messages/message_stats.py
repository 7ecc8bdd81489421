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
        self.last_message = None
        self.last_number = None
        self.start_time = None
        self.subscription = self.create_subscription(String, 'chatter', self.on_message, 10)

    def on_message(self, msg):
        now = time.time()
        if self.start_time is None:
            self.start_time = now
            self.first_message = msg.data
        self.total_count += 1
        self.last_message = msg.data
        number = int(msg.data.split(':')[1])
        if self.last_number is not None and number > self.last_number + 1:
            self.get_logger().warn(f'Gap: {number - self.last_number - 1} messages lost before {number}')
        self.last_number = number
        if self.total_count % 10 == 0:
            rate = self.total_count / (now - self.start_time)
            self.get_logger().info(
                f'[{self.total_count}] {rate:.2f} msg/s, first "{self.first_message}", last "{self.last_message}"'
            )


def main():
    rclpy.init()
    node = MessageStats()
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.02)
            time.sleep(0.02)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
