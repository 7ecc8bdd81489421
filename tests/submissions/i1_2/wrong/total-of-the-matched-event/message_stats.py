import time

import rclpy
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MessageStats(Node):
    """Counts while somebody publishes, and rests while nobody does."""

    def __init__(self):
        super().__init__('message_stats')
        self.active = False
        self.count = 0
        self.last_number = None
        events = SubscriptionEventCallbacks(matched=self.on_matched)
        self.create_subscription(String, 'chatter', self.on_message, 10, event_callbacks=events)

    def on_matched(self, status):
        if status.current_count == 0:
            self.active = False
        elif status.total_count == 1:  # the first publisher is there
            self.active = True

    def on_message(self, msg):
        if not self.active and self.count > 0:
            return
        if self.count == 0:
            self.first, self.start = msg.data, time.monotonic()
        self.count += 1
        number = int(msg.data.split(':')[-1])
        if self.last_number is not None and number > self.last_number + 1:
            self.get_logger().warn(f'{number - self.last_number - 1} messages lost')
        self.last_number = number
        if self.count % 10 == 0:
            rate = self.count / (time.monotonic() - self.start)
            self.get_logger().info(f'{self.count} messages, {rate:.2f} Hz, first "{self.first}", last "{msg.data}"')


def main():
    rclpy.init()
    node = MessageStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
