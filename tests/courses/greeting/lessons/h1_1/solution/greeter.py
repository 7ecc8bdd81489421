#!/usr/bin/env python3
"""Says hello on /greeting."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Greeter(Node):
    """A friendly node."""

    def __init__(self) -> None:
        super().__init__("greeter")
        self.publisher = self.create_publisher(String, "/greeting", 10)
        self.timer = self.create_timer(0.5, self.greet)

    def greet(self) -> None:
        """Say hello once."""
        self.publisher.publish(String(data="hello"))


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
