"""A node that listens to topics."""

from rclpy.node import Node


class ListeningNode(Node):
    def __init__(self, name):
        super().__init__(name)
        self.subscribe_to_all()

    def listen(self, message_type, topic, callback):
        self.create_subscription(message_type, topic, callback, 10)

    def subscribe_to_all(self):
        raise NotImplementedError
