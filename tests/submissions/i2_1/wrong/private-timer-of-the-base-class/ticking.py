"""A node that ticks."""

from rclpy.node import Node


class TickingNode(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.declare_parameter("publish_rate", 1.0)
        hz: float = self.get_parameter("publish_rate").value
        self.__timer = self.create_timer(1.0 / hz, self.tick)

    def tick(self) -> None:
        raise NotImplementedError
