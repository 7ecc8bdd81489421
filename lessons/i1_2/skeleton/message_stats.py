#!/usr/bin/env python3
"""Exercise I1.2: count the messages on /chatter, and log summaries."""

# TODO 1: import time, and dataclass from dataclasses.

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

# TODO 2: write a dataclass MessageStats: total_count, first_message,
#         last_message, start_time, messages_per_second.


class MessageStatsNode(Node):
    """Listens to a talker and keeps statistics on its messages."""

    def __init__(self) -> None:
        super().__init__("message_stats")
        # TODO 3: make a MessageStats, and remember that there has been
        #         no number yet: self.last_number = None.

        self.subscription = self.create_subscription(
            String,
            "chatter",
            self.on_message,
            10,
        )
        self.get_logger().info("Waiting for messages on /chatter")

    def on_message(self, message: String) -> None:
        """Handle one message. rclpy calls this for each."""
        # TODO 4: if it is the first one, keep its content and the time.

        # TODO 5: count it, keep its content as the last one, and
        #         compute the messages per second.

        # TODO 6: compare its number with the last one; warn if any are
        #         missing between the two.

        # TODO 7: every ten messages, log a summary: count, rate, first
        #         and last message.


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
