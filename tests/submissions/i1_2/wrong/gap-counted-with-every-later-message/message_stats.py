import time
from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


@dataclass
class Stats:
    count: int = 0
    gaps: int = 0
    offset: int = -1
    first: str = ''
    start: float = 0.0


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.stats = Stats()
        self.create_subscription(String, 'chatter', self.received, 10)

    def received(self, msg):
        s = self.stats
        number = int(msg.data.replace('Hello World: ', ''))
        if s.count == 0:
            s.first, s.start, s.offset = msg.data, time.monotonic(), number
        # the number must be the first one plus how many have come since
        if number > s.offset + s.count:
            s.gaps += 1
        s.count += 1
        if s.count % 10 == 0:
            rate = (s.count - 1) / (time.monotonic() - s.start)
            self.get_logger().info(
                f'{s.count} received ({rate:.1f} per second), gaps: {s.gaps}; first {s.first!r}, last {msg.data!r}'
            )


def main(args=None):
    rclpy.init(args=args)
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
