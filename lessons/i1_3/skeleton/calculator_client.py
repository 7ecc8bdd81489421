#!/usr/bin/env python3
"""Exercise I1.3: a node that calls the four services, then ends."""

import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 5: import AddTwoInts from example_interfaces.srv.


class CalculatorClient(Node):
    """Asks the calculator for one result after another."""

    def __init__(self) -> None:
        super().__init__("calculator_client")

    def run(self) -> bool:
        """Make all calls. Return whether every call was answered."""
        # TODO 6: for each of add, subtract, multiply and divide (and
        #         once more divide, by zero):
        #         - create a client for the service,
        #         - wait for the service, but not forever: log an error
        #           and return False if it does not come,
        #         - call it with call_async(),
        #         - let rclpy.spin_until_future_complete() run until the
        #           answer is here, again with a time limit,
        #         - log the result.

        self.get_logger().warning("This client calls nothing yet")
        return True


def main() -> None:
    """Run the client once. This part is complete.

    The exit code is 0 if all went well, 1 if not.
    """
    rclpy.init()
    node = CalculatorClient()
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
