# Copyright (c) 2024. Lab-internal example, do not redistribute.
"""Calculator server on a context of its own, so that it can live beside other ROS code in one process."""
from __future__ import annotations

import contextlib
from typing import Callable, Iterator, Optional

import rclpy
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts

BinaryOperation = Callable[[int, int], Optional[int]]


@contextlib.contextmanager
def ros_scope(node_name: str) -> Iterator[tuple[Node, SingleThreadedExecutor]]:
    """Yield a node and the executor it is attached to; clean up whatever happens."""
    context = Context()
    rclpy.init(context=context)
    node = Node(node_name, context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        yield node, executor
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown(context=context)


def divide(a: int, b: int) -> Optional[int]:
    """Return the quotient, or None where there is none."""
    return None if b == 0 else a // b


OPERATIONS: dict[str, BinaryOperation] = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": divide,
}


class Handler:
    """A callable service callback. One instance for each service."""

    def __init__(self, node: Node, name: str, operation: BinaryOperation) -> None:
        self._logger = node.get_logger()
        self._name = name
        self._operation = operation
        self._service = node.create_service(AddTwoInts, f"/{name}", self)

    def __call__(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        outcome = self._operation(request.a, request.b)
        if outcome is None:
            self._logger.error(f"{self._name}({request.a}, {request.b}) failed: division by zero")
            response.sum = 0
        else:
            self._logger.debug(f"{self._name}({request.a}, {request.b}) -> {outcome}")
            response.sum = outcome
        return response


def main() -> None:
    with ros_scope("calculator_server") as (node, executor):
        handlers = [Handler(node, name, operation) for name, operation in OPERATIONS.items()]
        node.get_logger().info(f"{len(handlers)} services are up")
        # No rclpy signal handler is installed for a context that is not the default one: wake up
        # now and then so that Python gets to raise KeyboardInterrupt.
        with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
            while node.context.ok():
                executor.spin_once(timeout_sec=0.2)


if __name__ == "__main__":
    main()
