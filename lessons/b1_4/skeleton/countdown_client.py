#!/usr/bin/env python3
"""Exercise B1.4: a node that sends one goal, then ends."""

import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 7: import ActionClient from rclpy.action, and Fibonacci from
#         example_interfaces.action.


class CountdownClient(Node):
    """Asks for one countdown."""

    def __init__(self) -> None:
        super().__init__("countdown_client")
        # TODO 8: create the action client.

    def run(self) -> bool:
        """Send the goal and wait. Return whether it succeeded."""
        # TODO 9: - wait for the action server, but not forever,
        #         - send a goal, with a callback that logs the newest
        #           number of each feedback message,
        #         - wait for the answer; if the goal was rejected, log
        #           an error and return False,
        #         - ask for the result, wait for it, and log it.

        self.get_logger().warning("This client sends nothing yet")
        return True


def main() -> None:
    """Run the client once. This part is complete.

    The exit code is 0 if all went well, 1 if not.
    """
    rclpy.init()
    node = CountdownClient()
    done = False
    try:
        done = node.run()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    if not done:
        sys.exit(1)


if __name__ == "__main__":
    main()
