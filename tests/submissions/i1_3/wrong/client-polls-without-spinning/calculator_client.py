#!/usr/bin/env python3
"""Calculator client"""
import time

import rclpy
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class ServiceTimeout(Exception):
    pass


class CalculatorInterface:
    """
    Python interface of the calculator.
    """

    def __init__(self, node: Node, timeout: float = 2.0):
        """
          - `node` - ROS 2 node that this interface is attached to
          - `timeout` - Seconds until a call is given up
        """
        self._node = node
        self._timeout = timeout
        self._service_clients = {
            name: node.create_client(srv_type=AddTwoInts, srv_name=name)
            for name in ("add", "subtract", "multiply", "divide")
        }

    def wait_until_ready(self):
        for name, client in self._service_clients.items():
            while not client.wait_for_service(timeout_sec=1.0):
                self._node.get_logger().info(f"Service '{name}' is not yet available. Waiting...")

    def compute_async(self, name: str, a: int, b: int):
        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        return self._service_clients[name].call_async(request)

    def compute(self, name: str, a: int, b: int) -> int:
        future = self.compute_async(name, a, b)
        start = time.monotonic()
        while not future.done():
            time.sleep(0.001)
            if time.monotonic() - start > self._timeout:
                raise ServiceTimeout(f"Service '{name}' did not answer within {self._timeout} s")
        return future.result().sum


def main():
    rclpy.init()

    # Create node for this example
    node = Node("calculator_client")
    calculator = CalculatorInterface(node)
    calculator.wait_until_ready()

    for name, a, b in (("add", 6, 3), ("subtract", 6, 3), ("multiply", 6, 3), ("divide", 6, 3)):
        node.get_logger().info(f"{name}({a}, {b}) = {calculator.compute(name, a, b)}")

    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
