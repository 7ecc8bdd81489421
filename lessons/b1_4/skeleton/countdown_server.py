#!/usr/bin/env python3
"""Exercise B1.4: an action server that counts down to zero."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 1: import ActionServer, and what its callbacks return, from
#         rclpy.action; and Fibonacci from example_interfaces.action.


class CountdownServer(Node):
    """Runs one countdown at a time: a new goal replaces the old one."""

    def __init__(self) -> None:
        super().__init__("countdown_server")
        # TODO 2: create the action server: /countdown, of type
        #         Fibonacci. Keep it in self.

        self.get_logger().info("Countdown server is up")

    # TODO 3: write the callback that executes a goal. From
    #         goal_handle.request.order down to 0, take one number after
    #         the other, with a quarter of a second between two of them.
    #         After each number, publish the numbers so far as feedback.
    #         At the end, say that the goal has succeeded, and return
    #         the result.

    # TODO 4: reject a goal whose order is below 0.

    # TODO 5: let a goal be canceled, and let a new goal replace the
    #         running one: look out for both between two numbers.


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = CountdownServer()
    try:
        # TODO 6: while a goal is executing, requests must get in: what
        #         has to run the callbacks for that?
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
