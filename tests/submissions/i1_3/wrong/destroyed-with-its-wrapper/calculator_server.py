#!/usr/bin/env python3
"""Calculator with four services. I come from rclcpp, so: RAII."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class ScopedService:
    """Owns a service and takes it down when it is not needed any more."""

    def __init__(self, node, name, callback):
        self._node = node
        self._service = node.create_service(AddTwoInts, name, callback)
        node.get_logger().info(f"service {self._service.srv_name} is up")

    def __del__(self):
        self._node.destroy_service(self._service)


class CalculatorServer(Node):
    def __init__(self):
        super().__init__("calculator_server")
        callbacks = {
            "add": self.on_add,
            "subtract": self.on_subtract,
            "multiply": self.on_multiply,
            "divide": self.on_divide,
        }
        for name, callback in callbacks.items():
            self.srv = ScopedService(self, name, callback)

    def on_add(self, request, response):
        response.sum = request.a + request.b
        return self.done("+", request, response)

    def on_subtract(self, request, response):
        response.sum = request.a - request.b
        return self.done("-", request, response)

    def on_multiply(self, request, response):
        response.sum = request.a * request.b
        return self.done("*", request, response)

    def on_divide(self, request, response):
        if request.b == 0:
            self.get_logger().error(f"{request.a} / 0: division by zero")
            response.sum = 0
            return response
        response.sum = request.a // request.b
        return self.done("/", request, response)

    def done(self, sign, request, response):
        self.get_logger().info(f"{request.a} {sign} {request.b} = {response.sum}")
        return response


def main():
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
