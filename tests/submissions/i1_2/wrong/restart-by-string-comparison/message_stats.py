#!/usr/bin/env python3
"""Message counter. Detects publisher restarts and resets its statistics then."""

import time
from dataclasses import dataclass, field

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


@dataclass
class MessageStats:
    total_count: int = 0
    first_message: str = ""
    last_message: str = ""
    start_time: float = field(default_factory=time.monotonic)

    @property
    def messages_per_second(self) -> float:
        elapsed = time.monotonic() - self.start_time
        return self.total_count / elapsed if elapsed > 0 else 0.0


class MessageStatsNode(Node):

    def __init__(self) -> None:
        super().__init__('message_stats')
        self.stats = None
        self.create_subscription(String, '/chatter', self.on_message, 50)

    def on_message(self, msg: String) -> None:
        if self.stats is None:
            self.stats = MessageStats(first_message=msg.data)
        elif msg.data < self.stats.last_message:
            # "Hello World: 0" comes before "Hello World: 57"
            self.get_logger().warning('Publisher was restarted, statistics start again at zero')
            self.stats = MessageStats(first_message=msg.data)
        else:
            self.check_gap(self.stats.last_message, msg.data)

        self.stats.total_count += 1
        self.stats.last_message = msg.data

        if self.stats.total_count % 10 == 0:
            self.get_logger().info(
                f'Messages: {self.stats.total_count}, '
                f'rate: {self.stats.messages_per_second:.1f} msg/s, '
                f'first: {self.stats.first_message}, last: {self.stats.last_message}')

    def check_gap(self, old: str, new: str) -> None:
        before = int(old.removeprefix('Hello World: '))
        after = int(new.removeprefix('Hello World: '))
        if after - before != 1:
            self.get_logger().warning(f'Sequence gap: {before} -> {after}')


def main() -> None:
    rclpy.init()
    node = MessageStatsNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
