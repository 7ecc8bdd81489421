#!/usr/bin/env python3
"""Calls the four services of the calculator, shows the results, then ends."""

import sys

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

EXAMPLES = (
    ("add", 10, 5),
    ("subtract", 10, 5),
    ("multiply", 10, -5),
    ("divide", 10, 5),
    ("divide", 10, 0),
)
WAIT_S = 5.0


class CalculatorClient(Node):
    """Asks the calculator for one result after another."""

    def __init__(self) -> None:
        super().__init__("calculator_client")

    def run(self) -> bool:
        """Make all calls. Return whether every call was answered."""
        return all(self.call(name, a, b) for name, a, b in EXAMPLES)

    def call(self, name: str, a: int, b: int) -> bool:
        """Call one service and log its result. Return whether there was an answer."""
        client = self.create_client(AddTwoInts, name)
        if not client.wait_for_service(timeout_sec=WAIT_S):
            self.get_logger().error(f"There is no service {name}: is calculator_server.py running?")
            return False
        # call_async() returns a future at once: a promise of the answer. The answer arrives while the node spins.
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future, timeout_sec=WAIT_S)
        if not future.done():
            self.get_logger().error(f"The service {name} did not answer within {WAIT_S} s")
            return False
        self.get_logger().info(f"{name}({a}, {b}) = {future.result().sum}")
        return True


def main() -> None:
    """Run the client once: exit code 0 if all went well, 1 if not."""
    rclpy.init()
    node = CalculatorClient()
    done = False
    try:
        done = node.run()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C: not an error worth a traceback, but not done either.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    if not done:
        sys.exit(1)


if __name__ == "__main__":
    main()
