#!/usr/bin/env python3
"""Statistics for /chatter, with the receive window of our transport protocol lab."""
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ReceiveWindow:
    """Keeps track of which sequence numbers have arrived and which are still missing."""

    def __init__(self):
        self.next_seq = None
        self.missing = []

    def accept(self, seq):
        """Take one sequence number, return the numbers that were skipped before it."""
        if self.next_seq is None:
            self.next_seq = seq

        if seq < self.next_seq:
            # arrived late, the hole is filled now
            self.missing.remove(seq)
            return []

        hole = list(range(self.next_seq, seq))
        self.missing.extend(hole)
        self.next_seq = seq + 1
        return hole


class Stopwatch:
    def __init__(self):
        self.started_at = None

    def lap(self):
        now = time.monotonic()
        if self.started_at is None:
            self.started_at = now
        return now - self.started_at


class ChatterReceiver(Node):

    def __init__(self):
        super().__init__('chatter_receiver')
        self.window = ReceiveWindow()
        self.watch = Stopwatch()
        self.received = 0
        self.first = self.last = None
        self.create_subscription(String, 'chatter', self.on_packet, 10)

    def on_packet(self, msg):
        seconds = self.watch.lap()
        self.received += 1
        if self.first is None:
            self.first = msg.data
        self.last = msg.data

        hole = self.window.accept(int(msg.data.rsplit(':', 1)[1]))
        if hole:
            self.get_logger().warning(
                'sequence gap: %d packet(s) missing, %d..%d' % (len(hole), hole[0], hole[-1]))

        if self.received % 10 == 0:
            self.report(seconds)

    def report(self, seconds):
        throughput = self.received / seconds if seconds else 0.0
        self.get_logger().info(
            'received: %d  throughput: %.2f msg/s  first: "%s"  last: "%s"'
            % (self.received, throughput, self.first, self.last))


def main(args=None):
    rclpy.init(args=args)
    receiver = ChatterReceiver()
    try:
        rclpy.spin(receiver)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        receiver.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
