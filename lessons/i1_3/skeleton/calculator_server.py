#!/usr/bin/env python3
"""Exercise I1.3: a node with four services, one for each operation."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 1: import AddTwoInts from example_interfaces.srv.


class CalculatorServer(Node):
    """Adds, subtracts, multiplies and divides on request."""

    def __init__(self) -> None:
        super().__init__("calculator_server")
        # TODO 2: create the services add, subtract, multiply and
        #         divide, all of type AddTwoInts. Start with one, check
        #         it, then write the others.

        self.get_logger().info("Calculator is up")

    # TODO 3: write one callback for each service. It is given a request
    #         (a and b) and an empty response: fill in response.sum,
    #         log what was computed, and return the response.

    # TODO 4: in the callback of divide, look at b first. If it is 0,
    #         log an error and still return the response.


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
