#!/usr/bin/env python3
# Monitor the rate of one or more String topics with a single node.
#   message_stats.py [topic1 topic2 ...]        (default: /chatter)

import datetime
import os
import sys
import time

TOPICS = (
    "/chatter",
)
# TOPICS = (
#   "/cam0/status",
#   "/cam1/status",
# )


def main() -> int:
    try:
        import rclpy
        from rclpy.node import Node
        from rclpy.utilities import remove_ros_args
        from std_msgs.msg import String
    except Exception as exc:
        print("ERROR: cannot import the ROS 2 Python packages:", exc, file=sys.stderr)
        print("Is the ROS 2 environment sourced?", file=sys.stderr)
        return 1

    topics = remove_ros_args(args=sys.argv)[1:] or list(TOPICS)
    every = 10

    rclpy.init(args=None)

    class FPSNode(Node):
        def __init__(self, topic_list, print_every):
            super().__init__(f"topic_fps_monitor_{os.getpid()}")
            self._topics = topic_list
            self._every = print_every
            self._counts = {topic: 0 for topic in topic_list}
            self._totals = {topic: 0 for topic in topic_list}
            self._gaps = {topic: 0 for topic in topic_list}
            self._last_print = {}
            self._firsts = {}
            self._lasts = {}
            self._numbers = {}

            for topic in topic_list:
                self.create_subscription(
                    String,
                    topic,
                    self._make_cb(topic),
                    50,
                )

        def _make_cb(self, topic):
            def _cb(msg):
                # the first window opens with the first message
                self._last_print.setdefault(topic, time.monotonic())
                self._firsts.setdefault(topic, msg.data)
                self._lasts[topic] = msg.data
                self._follow(topic, int(msg.data.split(":")[-1]))
                self._counts[topic] += 1
                self._totals[topic] += 1
                if self._counts[topic] == self._every:
                    self._print_stats(topic)
            return _cb

        def _follow(self, topic, number):
            previous = self._numbers.get(topic, number - 1)
            self._numbers[topic] = number
            if number > previous + 1:
                self._gaps[topic] += 1
            elif number <= previous:
                self.get_logger().info(f"{topic}: numbering starts over at {number}")

        def _print_stats(self, topic):
            now = time.monotonic()
            dt = max(now - self._last_print[topic], 1e-6)
            self._last_print[topic] = now

            ts = datetime.datetime.now().strftime("%H:%M:%S")
            width = max(len(t) for t in self._topics)
            count = self._counts[topic]
            self._counts[topic] = 0
            fps = count / dt
            total = self._totals[topic]
            self.get_logger().info(
                f"[{ts}] {topic.ljust(width)}  rate={fps:6.2f} msg/s  total={total:8d}  "
                f"gaps={self._gaps[topic]:3d}  "
                f"first='{self._firsts[topic]}'  last='{self._lasts[topic]}'"
            )

    node = FPSNode(topics, every)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()

    return 0


if __name__ == "__main__":
    raise SystemExit(main())
