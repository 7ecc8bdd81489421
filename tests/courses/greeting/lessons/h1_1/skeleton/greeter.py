#!/usr/bin/env python3
"""Says hello on /greeting."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Greeter(Node):
    """A friendly node."""

    def __init__(self) -> None:
        super().__init__("greeter")
        # TODO: create a publisher of std_msgs/msg/String on /greeting, and a timer of 0.5 s that publishes "hello".


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = Greeter()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
