# Copyright (c) 2024. Lab-internal example, do not redistribute.
"""Demonstrates the calculator with blocking calls; the executor spins in the background."""
from __future__ import annotations

from threading import Thread
from typing import Dict, Optional

import rclpy
from rclpy.client import Client
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class CalculatorProxy:
    """Wraps the service clients so that they can be called like functions."""

    def __init__(self, node_name: str = "calculator_client") -> None:
        self._context = Context()
        rclpy.init(context=self._context)
        self._node = Node(node_name, context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._clients: Dict[str, Client] = {}
        self._thread = Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            pass

    def __enter__(self) -> CalculatorProxy:
        return self

    def __exit__(self, *exc_info: object) -> None:
        rclpy.try_shutdown(context=self._context)
        self._thread.join(timeout=5.0)

    def __call__(self, service: str, a: int, b: int, timeout_sec: Optional[float] = 5.0) -> int:
        client = self._clients.get(service)
        if client is None:
            client = self._node.create_client(AddTwoInts, service)
            self._clients[service] = client
        if not client.wait_for_service(timeout_sec=10.0):
            raise TimeoutError(f"{service} is not available")
        response = client.call(AddTwoInts.Request(a=a, b=b), timeout_sec=timeout_sec)
        if response is None:
            raise TimeoutError(f"{service} did not answer")
        return response.sum


def main() -> None:
    with CalculatorProxy() as calculator:
        print("21 + 21 =", calculator("/add", 21, 21))
        print("-8 - 34 =", calculator("/subtract", -8, 34))
        print("-6 * -7 =", calculator("/multiply", -6, -7))
        print("84 / 2  =", calculator("/divide", 84, 2))


if __name__ == "__main__":
    main()
