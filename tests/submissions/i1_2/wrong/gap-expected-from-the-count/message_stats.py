import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.total_count = 0
        self.first_message = None
        self.last_message = None
        self.start_time = None
        self.last_number = None
        self.subscription = self.create_subscription(String, "chatter", self.callback, 10)

    def callback(self, msg):
        now = time.time()
        if self.start_time is None:
            self.start_time = now
            self.first_message = msg.data
        self.total_count += 1
        self.last_message = msg.data
        self.check_gap(msg.data)
        if self.total_count % 10 == 0:
            self.summary(now)

    def check_gap(self, data):
        number = int(data.split(': ')[1])
        if number != self.total_count - 1:
            self.get_logger().warning(f"Gap detected: expected {self.total_count - 1}, got {number}")

    def summary(self, now):
        rate = self.total_count / (now - self.start_time)
        self.get_logger().info(
            f"Stats: count={self.total_count}, rate={rate:.2f} msg/s, "
            f'first="{self.first_message}", last="{self.last_message}"'
        )


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


if __name__ == "__main__":
    main()
