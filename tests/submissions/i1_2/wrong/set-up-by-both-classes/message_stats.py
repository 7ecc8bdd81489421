import time

import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

from listening import ListeningNode


class MessageStats(ListeningNode):
    def __init__(self):
        super().__init__("message_stats")
        self.total = 0
        self.first = None
        self.began = 0.0
        self.number = None
        self.subscribe_to_all()

    def subscribe_to_all(self):
        self.listen(String, "/chatter", self.heard)

    def heard(self, msg):
        if self.first is None:
            self.first, self.began = msg.data, time.monotonic()
        self.total += 1
        self.look_for_gap(int(msg.data.rsplit(" ", 1)[1]))
        if self.total % 10 == 0:
            rate = self.total / max(time.monotonic() - self.began, 1e-9)
            self.get_logger().info(f'{self.total} messages, {rate:.2f} per second, from "{self.first}" to "{msg.data}"')

    def look_for_gap(self, number):
        if self.number is not None and number > self.number + 1:
            self.get_logger().warning(f"missing: {self.number + 1} to {number - 1}")
        elif self.number is not None and number < self.number:
            self.get_logger().info("the talker has started again")
        self.number = number


def main():
    rclpy.init()
    node = MessageStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
