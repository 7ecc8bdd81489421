#!/usr/bin/python3


import re
from time import monotonic

import rclpy # rospy for ROS2
from rclpy.node import Node
from std_msgs.msg import String # msg used by the talker


"""
Node which listens to "chatter" and keeps statistics about it
"""
class StatsNode(Node):

    def __init__(self, node_name: str = "message_stats"):
        super().__init__(node_name)
        self.get_logger().info(f"Started node at: {self.get_fully_qualified_name()}")

        """
        Everything we know about a message: text, number and time of arrival
        """
        self.total = 0
        self.first = self.last = {"text": "", "number": None, "time": 0.0}
        self.start = None

        """
        - 20: queue size (msgs to keep in case node is slowed down)
        """
        self.subscriber = self.create_subscription(
            String, "chatter", self.callback_function, 20
        )
        self.get_logger().info(
            f"Subscribing to messages from: {self.subscriber.topic_name}"
        )

    """
    Main loop for processing input
    """
    def callback_function(self, message: String) -> None:

        now = monotonic()
        digits = re.search(r"(\d+)\s*$", message.data)
        number = int(digits.group(1)) if digits else None

        # compare with the message before
        if self.total > 0 and number is not None and self.last["number"] is not None:
            step = number - self.last["number"]
            if step > 1:
                self.get_logger().warn(f"Gap in the sequence, {step - 1} messages missing")
            elif step < 1:
                self.get_logger().warn("Talker was restarted")

        if self.total == 0:
            self.start = now
            self.first["text"] = message.data
            self.first["number"] = number
            self.first["time"] = now

        self.last["text"] = message.data
        self.last["number"] = number
        self.last["time"] = now
        self.total += 1

        if self.total % 10 == 0:
            self.print_summary()

    def print_summary(self) -> None:
        seconds = self.last["time"] - self.start
        rate = self.total / seconds if seconds > 0 else 0.0
        self.get_logger().info(
            f"total: {self.total}, rate: {rate:.2f} msg/s, "
            f"first: {self.first['text']!r}, last: {self.last['text']!r}"
        )


def main(args=None):
    rclpy.init(args=args)           # if any args specified on node startup
    statsnode = StatsNode()         # class above
    rclpy.spin(statsnode)           # spin = run for as long as it's on
    rclpy.shutdown()


if __name__ == "__main__":
    main()
