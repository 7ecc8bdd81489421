#!/usr/bin/env python3
"""Calculator server, table driven."""
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class CalculatorServer(Node):
    """Keeps its services in a dict, so that they can be looked up by name."""

    def __init__(self):
        super().__init__('calculator_server')
        callbacks = {
            'add': self._on_add,
            'subtract': self._on_subtract,
            'multiply': self._on_multiply,
            'divide': self._on_divide,
        }
        self._services = {
            name: self.create_service(AddTwoInts, name, callback)
            for name, callback in callbacks.items()
        }
        self.get_logger().info(f'Ready: {sorted(self._services)}')

    def _on_add(self, request, response):
        response.sum = request.a + request.b
        return response

    def _on_subtract(self, request, response):
        response.sum = request.a - request.b
        return response

    def _on_multiply(self, request, response):
        response.sum = request.a * request.b
        return response

    def _on_divide(self, request, response):
        if request.b == 0:
            self.get_logger().error('Division by zero')
            response.sum = 0
            return response
        response.sum = request.a // request.b
        return response


def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
