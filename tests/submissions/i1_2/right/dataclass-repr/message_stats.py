import time
from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


@dataclass
class MessageStats:
    total_count: int = 0
    first_message: str = ""
    last_message: str = ""
    start_time: float = 0.0
    messages_per_second: float = 0.0
    gaps: int = 0


class MessageStatsNode(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.stats = MessageStats()
        self.last_n = None
        self.sub = self.create_subscription(String, "chatter", self.cb, 10)

    def cb(self, msg):
        s = self.stats
        if s.total_count == 0:
            s.start_time = time.time()
            s.first_message = msg.data
        s.total_count += 1
        s.last_message = msg.data
        elapsed = time.time() - s.start_time
        if elapsed > 0:
            s.messages_per_second = s.total_count / elapsed
        n = int(msg.data.replace("Hello World: ", ""))
        if self.last_n is not None and n > self.last_n + 1:
            s.gaps += 1
        self.last_n = n
        if s.total_count % 10 == 0:
            self.get_logger().info(f"{s!r}")


def main():
    rclpy.init()
    node = MessageStatsNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
