import time

import rclpy
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.count = 0
        self.first = None
        self.started = None
        events = SubscriptionEventCallbacks(message_lost=self.on_lost)
        self.create_subscription(String, 'chatter', self.on_message, 10, event_callbacks=events)

    def on_lost(self, info):
        self.get_logger().warning(f'{info.total_count_change} messages lost, {info.total_count} in all')

    def on_message(self, msg):
        now = time.monotonic()
        if self.started is None:
            self.started = now
            self.first = msg.data
        self.count += 1
        if self.count % 10 == 0:
            rate = (self.count - 1) / (now - self.started)
            self.get_logger().info(f'{self.count} messages, {rate:.2f} per second, "{self.first}" to "{msg.data}"')


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
