#!/usr/bin/env python3
"""Offers the services /add, /subtract, /multiply and /divide."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


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
        response.sum = request.a + request.b
        self.get_logger().info(f"{request.a} + {request.b} = {response.sum}")
        return response

    def subtract(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a - b."""
        response.sum = request.a - request.b
        self.get_logger().info(f"{request.a} - {request.b} = {response.sum}")
        return response

    def multiply(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a * b."""
        response.sum = request.a * request.b
        self.get_logger().info(f"{request.a} * {request.b} = {response.sum}")
        return response

    def divide(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a // b, or with 0 and an error in the log where b is 0."""
        if request.b == 0:
            # The response has no field for an error, so the log says it. The caller still gets an answer.
            self.get_logger().error(f"Cannot divide {request.a} by zero")
            response.sum = 0
            return response
        # Two slashes: one slash makes a float, and the field is an int64.
        response.sum = request.a // request.b
        self.get_logger().info(f"{request.a} / {request.b} = {response.sum}")
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
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has shut down already.


if __name__ == "__main__":
    main()
