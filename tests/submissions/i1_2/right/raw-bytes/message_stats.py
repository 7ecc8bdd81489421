#!/usr/bin/env python3
# small "ros2 topic hz + bw" for one topic, takes the messages serialized
import math
import sys
import time
from collections import deque
from dataclasses import dataclass, field

import rclpy
import rclpy.qos
import rclpy.serialization
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

WINDOW_SEC = 5.0


def human_size(n: float) -> str:
    suffixes = ["B", "KB", "MB", "GB"]
    if n < 1:
        return "0 B"
    log1000 = min(int(math.log10(n) // 3), 3)
    return f"{n / (1000 ** log1000):.1f} {suffixes[log1000]}"


class ANSI:
    RED = "\x1b[31m"
    YELLOW = "\x1b[33m"
    BOLD = "\x1b[1m"
    RESET = "\x1b[0m"


@dataclass
class TopicStatistics:
    recv_times: deque[float] = field(default_factory=deque)
    sizes: deque[int] = field(default_factory=deque)
    total_count: int = 0
    first: str | None = None
    last: str | None = None
    index: int | None = None
    gap_count: int = 0

    def append(self, recv_time: float, size: int) -> None:
        self.total_count += 1
        self.recv_times.append(recv_time)
        self.sizes.append(size)
        while recv_time - self.recv_times[0] > WINDOW_SEC and len(self.recv_times) > 2:
            self.recv_times.popleft()
            self.sizes.popleft()

    def frequency(self) -> float:
        if len(self.recv_times) < 2:
            return 0.0
        span = self.recv_times[-1] - self.recv_times[0]
        return (len(self.recv_times) - 1) / span if span > 0 else 0.0

    def bandwidth(self) -> float:
        if not self.sizes:
            return 0.0
        return sum(self.sizes) / len(self.sizes) * self.frequency()


class StatsNode(Node):
    def __init__(self, topic: str):
        super().__init__("message_stats")
        self.topic = topic
        self.stats = TopicStatistics()
        self.sub = self.create_subscription(
            String,
            topic,
            self.on_serialized,
            rclpy.qos.QoSProfile(depth=100),
            raw=True,
        )

    def on_serialized(self, data: bytes) -> None:
        now = time.monotonic()
        st = self.stats
        text = rclpy.serialization.deserialize_message(data, String).data

        st.append(now, len(data))
        if st.first is None:
            st.first = text
        st.last = text
        self.follow(text)

        if st.total_count % 10 == 0:
            self.get_logger().info(self.render())

    def follow(self, text: str) -> None:
        st = self.stats
        word = text.split()[-1] if text.split() else ""
        if not word.isdigit():
            return
        index, expected = int(word), None if st.index is None else st.index + 1
        st.index = index
        if expected is None or index == expected:
            return
        if index > expected:
            st.gap_count += 1
            self.get_logger().warning(
                f"{ANSI.YELLOW}gap: expected {expected} but received {index}{ANSI.RESET}")
        else:
            self.get_logger().info(f"index fell from {expected - 1} to {index} (new publisher)")

    def render(self) -> str:
        st = self.stats
        rows = [
            f"{ANSI.BOLD}{self.topic}{ANSI.RESET}",
            f"  count     {st.total_count}",
            f"  rate      {st.frequency():.2f} msg/s",
            f"  bandwidth {human_size(st.bandwidth())}/s",
            f"  first     {st.first}",
            f"  last      {st.last}",
            f"  gaps      {st.gap_count}",
        ]
        return "\n".join(rows)


def main() -> int:
    rclpy.init(args=sys.argv)
    node = StatsNode("/chatter")
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
