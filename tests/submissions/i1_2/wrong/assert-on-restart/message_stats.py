import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from enum import Enum
from std_msgs.msg import String
from dataclasses import dataclass, field
from time import monotonic


class State(Enum):
    WAITING = 0
    IN_ORDER = 1
    OUT_OF_ORDER = 2


@dataclass
class ReceiveState:
    state: State = State.WAITING
    expected: int = 0
    missing: int = 0
    total: int = 0
    first: str = ""
    last: str = ""
    started: float = field(default=0.0)

    def receive(self, text: str) -> int:
        """Take a message in; returns how many are missing before it."""
        _, _, tail = text.rpartition(" ")
        number = int(tail)

        if self.state is State.WAITING:
            self.expected = number
            self.first = text
            self.started = monotonic()

        assert number >= self.expected, f"expected {self.expected} or later, received {number}"

        skipped = number - self.expected
        self.state = State.OUT_OF_ORDER if skipped else State.IN_ORDER
        self.missing += skipped
        self.expected = number + 1
        self.total += 1
        self.last = text
        return skipped

    @property
    def rate(self) -> float:
        return self.total / (monotonic() - self.started)


class MessageStats(Node):
    """
    Node that expects the numbered messages of topic chatter in order
    """

    def __init__(self):
        super().__init__('message_stats')

        self.declare_parameter('nr_messages_per_summary', 10)
        self.nr_messages = self.get_parameter('nr_messages_per_summary').get_parameter_value().integer_value

        self.block = ReceiveState()

        self.all_subscriptions = [self.create_subscription(
            String, topic,
            lambda msg, topic=topic: self.listener_callback(topic, msg), 10)
            for topic in ('/chatter',)]

    def listener_callback(self, topic, msg):
        skipped = self.block.receive(msg.data)

        if self.block.state is State.OUT_OF_ORDER:
            self.get_logger().warning(f'{topic}: {skipped} messages missing before "{msg.data}"')

        if self.block.total % self.nr_messages == 0:
            self.get_logger().info(
                f'{topic}: received {self.block.total} messages at {self.block.rate:.2f} msg/s, '
                f'first "{self.block.first}", last "{self.block.last}", missing {self.block.missing}')


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
