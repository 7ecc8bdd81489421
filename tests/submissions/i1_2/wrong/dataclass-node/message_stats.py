import time
from dataclasses import dataclass

import rclpy
from rclpy.node import Node
from rclpy.subscription import Subscription

from std_msgs.msg import String

## how long we'll keep the data (DDS).
QUEUE_SIZE: int = 10

## how often we say something.
SUMMARY_EVERY: int = 10


@dataclass(kw_only=True)
class MessageStatsNode(Node):
    ## to make us a subscriber
    _subscription: Subscription

    ## how many msgs we've recv'd
    _msg_ct: int = 0

    ## when we recv'd the first one
    _start_time: float = 0.0

    ## content of the first and last msg
    _first: str = ""
    _last: str = ""

    ## number of the last msg, or -1
    _number: int = -1

    def __init__(self):
        """
        Creates a new `MessageStatsNode`.
        """

        # give the node a name.
        super().__init__("message_stats")

        # ...and subscribe.
        self._subscription = self.create_subscription(
            msg_type=String,
            topic="/chatter",
            callback=self._recv,
            qos_profile=QUEUE_SIZE,
        )

    def _recv(self, msg: String):
        """
        Takes a message, and does all the counting.
        """
        now: float = time.time()

        if self._msg_ct == 0:
            self._start_time = now
            self._first = msg.data

        self._msg_ct += 1
        self._last = msg.data

        number: int = int(msg.data.split(" ")[-1])
        if self._msg_ct > 1 and number > self._number + 1:
            self.get_logger().warning(f"we've lost {number - self._number - 1} msgs!")
        elif number < self._number:
            self.get_logger().info("publisher restarted.")
        self._number = number

        if self._msg_ct % SUMMARY_EVERY == 0:
            rate: float = self._msg_ct / (now - self._start_time)
            self.get_logger().info(
                f"recv'd {self._msg_ct} msgs at {rate:.2f} msgs/s. "
                f"first: `{self._first}`, last: `{self._last}`"
            )


def main(args: list[str] | None = None):
    """
    Starts up the node.
    """
    rclpy.init(args=args)
    node: MessageStatsNode = MessageStatsNode()

    rclpy.spin(node)

    # destroy the Node after spinning ends
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
