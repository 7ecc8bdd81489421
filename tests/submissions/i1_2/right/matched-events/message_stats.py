import re
import time

import rclpy
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import String


class ChatterWatch(Node):
    """Counts; tells when publishers come and go, as the middleware reports it."""

    def __init__(self):
        super().__init__('chatter_watch')
        self.total = 0
        self.first = ''
        self.last = ''
        self.t0 = 0.0
        self.expected = None
        qos = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)
        self.sub = self.create_subscription(
            String, 'chatter', self.heard, qos,
            event_callbacks=SubscriptionEventCallbacks(matched=self.matched))

    def matched(self, event):
        if event.current_count_change > 0:
            self.get_logger().info('A publisher has connected.')
        elif event.current_count == 0:
            self.get_logger().warning('The publisher has gone. Waiting for the next one ...')

    def heard(self, msg):
        if self.total == 0:
            self.t0 = time.monotonic()
            self.first = msg.data
        self.total += 1
        self.last = msg.data
        found = re.search(r'(\d+)\s*$', msg.data)
        if found:
            number = int(found.group(1))
            if self.expected is not None and number > self.expected:
                self.get_logger().error(
                    f'Sequence gap: expected {self.expected}, got {number}')
            self.expected = number + 1
        if self.total % 10 == 0:
            rate = self.total / max(time.monotonic() - self.t0, 1e-6)
            self.get_logger().info(f'Statistics after {self.total} messages: {rate:.1f} per second, '
                                   f'first: {self.first}, last: {self.last}')


def main():
    rclpy.init()
    node = ChatterWatch()
    with SingleThreadedExecutor() as executor:
        executor.add_node(node)
        try:
            executor.spin()
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
