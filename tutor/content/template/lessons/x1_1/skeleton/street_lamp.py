#!/usr/bin/env python3
"""Says on /street_lamp/status that it is ready."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class StreetLamp(Node):
    """A node that tells its state."""

    def __init__(self) -> None:
        super().__init__("street_lamp")
        # TODO 1: make a publisher of std_msgs/msg/String on /street_lamp/status
        # TODO 2: make a timer that calls self.tell twice a second

    def tell(self) -> None:
        """Say once that the node is ready."""
        # TODO 3: publish a String with ready in its data


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
