from typing import Callable, Optional

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.subscription import Subscription
from rclpy.time import Time
from std_msgs.msg import String


class SequenceWatch:
    def __init__(self, on_gap: Callable[[int, int], None], on_restart: Callable[[int, int], None]) -> None:
        self.on_gap = on_gap
        self.on_restart = on_restart
        self.previous_seq: Optional[int] = None

    def update(self, seq: int) -> None:
        if self.previous_seq is not None:
            if seq > self.previous_seq + 1:
                self.on_gap(self.previous_seq, seq)
            elif seq <= self.previous_seq:
                self.on_restart(self.last_seq, seq)
        self.previous_seq = seq


class MessageStats:
    def __init__(self) -> None:
        self.total_count: int = 0
        self.first_message: str = ""
        self.last_message: str = ""
        self.start_time: Optional[Time] = None
        self.restarts: int = 0

    def messages_per_second(self, now: Time) -> float:
        seconds = (now - self.start_time).nanoseconds * 1e-9
        return self.total_count / seconds if seconds > 0.0 else 0.0


class MessageStatsNode(Node):
    def __init__(self) -> None:
        super().__init__("message_stats")
        self.stats: MessageStats = MessageStats()
        self.watch: SequenceWatch = SequenceWatch(self._gap, self._restart)
        self.chatter_subscription: Subscription = self.create_subscription(
            String, "chatter", self._chatter, 10)

    def _gap(self, before: int, after: int) -> None:
        self.get_logger().warning(f"Gap in the sequence between {before} and {after}")

    def _restart(self, before: int, after: int) -> None:
        self.stats.restarts += 1
        self.get_logger().warning(f"Publisher restarted ({before} -> {after}), going on with the total")

    def _chatter(self, msg: String) -> None:
        now = self.get_clock().now()
        if self.stats.start_time is None:
            self.stats.start_time = now
            self.stats.first_message = msg.data
        self.stats.total_count += 1
        self.stats.last_message = msg.data

        number = msg.data.split()[-1]
        if number.isdecimal():
            self.watch.update(int(number))

        if self.stats.total_count % 10 == 0:
            self.get_logger().info(
                f"Stats: total={self.stats.total_count}, "
                f"rate={self.stats.messages_per_second(now):.2f} msg/s, "
                f"first='{self.stats.first_message}', last='{self.stats.last_message}'")


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


if __name__ == "__main__":
    main()
