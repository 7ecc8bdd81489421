#!/usr/bin/env python3
"""Says on /street_lamp/status that it is ready."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class StreetLamp(Node):
    """A node that tells its state."""

    def __init__(self) -> None:
        super().__init__("street_lamp")
        self.publisher = self.create_publisher(String, "/street_lamp/status", 10)
        self.timer = self.create_timer(0.5, self.tell)

    def tell(self) -> None:
        """Say once that the node is ready."""
        self.publisher.publish(String(data="ready"))


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = StreetLamp()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
