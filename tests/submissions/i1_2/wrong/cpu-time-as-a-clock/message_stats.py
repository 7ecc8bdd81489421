#!/usr/bin/env python3
"""Exercise I1.2: count the messages on /chatter, and log summaries."""

from dataclasses import dataclass
from time import process_time

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


class MessageStatsNode(Node):
    """Listens to a talker and keeps statistics on its messages."""

    def __init__(self) -> None:
        super().__init__("message_stats")
        self.stats = MessageStats()
        self.last_number = None

        self.subscription = self.create_subscription(
            String,
            "chatter",
            self.on_message,
            10,
        )
        self.get_logger().info("Waiting for messages on /chatter")

    def on_message(self, message: String) -> None:
        """Handle one message. rclpy calls this for each."""
        # first one?
        if self.stats.total_count == 0:
            self.stats.first_message = message.data
            self.stats.start_time = process_time()

        self.stats.total_count += 1
        self.stats.last_message = message.data
        elapsed = process_time() - self.stats.start_time
        if elapsed > 0:
            self.stats.messages_per_second = (self.stats.total_count - 1) / elapsed

        # gaps
        try:
            number = int(message.data.replace("Hello World:", ""))
        except ValueError:
            self.get_logger().info("That is no Hello World message")
        else:
            if self.last_number is not None:
                missing = number - self.last_number - 1
                if missing > 0:
                    self.get_logger().warning(f"Missed {missing} messages!")
            self.last_number = number

        # summary
        if self.stats.total_count % 10 == 0:
            self.get_logger().info(
                f"Summary: count={self.stats.total_count} "
                f"rate={self.stats.messages_per_second:.2f} Hz "
                f"first={self.stats.first_message!r} "
                f"last={self.stats.last_message!r}"
            )


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
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
