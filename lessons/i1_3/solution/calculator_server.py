#!/usr/bin/env python3
"""Offers the services /add, /subtract, /multiply and /divide."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

INT64_MIN, INT64_MAX = -(2**63), 2**63 - 1


class CalculatorServer(Node):
    """Adds, subtracts, multiplies and divides on request."""

    def __init__(self) -> None:
        super().__init__("calculator_server")
        self.create_service(AddTwoInts, "add", self.add)
        self.create_service(AddTwoInts, "subtract", self.subtract)
        self.create_service(AddTwoInts, "multiply", self.multiply)
        self.create_service(AddTwoInts, "divide", self.divide)
        self.get_logger().info("Calculator is up: add, subtract, multiply, divide")

    def add(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a + b."""
        return self.answer(f"{request.a} + {request.b}", request.a + request.b, response)

    def subtract(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a - b."""
        return self.answer(f"{request.a} - {request.b}", request.a - request.b, response)

    def multiply(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a * b."""
        return self.answer(f"{request.a} * {request.b}", request.a * request.b, response)

    def divide(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a // b; if b is 0, log an error and answer with 0."""
        if request.b == 0:
            # The response has no field for an error, so log it. The caller still gets an answer.
            self.get_logger().error(f"Cannot divide {request.a} by zero")
            response.sum = 0
            return response
        # Two slashes: a single slash gives a float, and the field is an int64.
        return self.answer(f"{request.a} / {request.b}", request.a // request.b, response)

    def answer(self, question: str, result: int, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Log the result, and put it, or the nearest number that fits into an int64, into the response."""
        # Python's integers have no limit, but an int64 has: a larger result would raise OverflowError and end the node.
        response.sum = max(INT64_MIN, min(result, INT64_MAX))
        if response.sum == result:
            self.get_logger().info(f"{question} = {result}")
        else:
            self.get_logger().error(f"{question} = {result} does not fit into an int64: answering {response.sum}")
        return response


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
