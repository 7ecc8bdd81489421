#!/usr/bin/env python3
"""Exercise I1.3: a node that calls the four services, then ends."""

import asyncio
import sys

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

WAIT_SECONDS = 5.0
CALLS = (
    ("add", 8, 2),
    ("subtract", 8, 2),
    ("multiply", 8, 2),
    ("divide", 8, 2),
    ("divide", 8, 0),
)


class CalculatorClient(Node):
    """Asks the calculator for one result after another."""

    def __init__(self) -> None:
        super().__init__("calculator_client")
        self.endpoints = {
            name: self.create_client(AddTwoInts, name)
            for name in ("add", "subtract", "multiply", "divide")
        }

    async def fetch(self, name: str, a: int, b: int) -> int:
        """Call one service and return its answer."""
        endpoint = self.endpoints[name]
        if not endpoint.wait_for_service(timeout_sec=WAIT_SECONDS):
            raise ConnectionError(f"service /{name} is not available")
        response = await asyncio.wait_for(
            endpoint.call_async(AddTwoInts.Request(a=a, b=b)),
            timeout=WAIT_SECONDS,
        )
        return response.sum

    async def run(self) -> bool:
        """Make all calls. Return whether every call was answered."""
        for name, a, b in CALLS:
            try:
                result = await self.fetch(name, a, b)
            except ConnectionError as error:
                self.get_logger().error(str(error))
                return False
            except asyncio.TimeoutError:
                self.get_logger().error(f"/{name} did not answer in time")
                return False
            self.get_logger().info(f"{name} {a} {b} -> {result}")
        return True


def main() -> None:
    """Run the client once.

    The exit code is 0 if all went well, 1 if not.
    """
    rclpy.init()
    node = CalculatorClient()
    done = False
    try:
        done = asyncio.run(node.run())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    if not done:
        sys.exit(1)


if __name__ == "__main__":
    main()
