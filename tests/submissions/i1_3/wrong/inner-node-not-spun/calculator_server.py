"""Two nodes: one adds and subtracts, and holds the other, which multiplies and divides."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Products(Node):
    def __init__(self):
        super().__init__("products")
        self.create_service(AddTwoInts, "multiply", self.multiply)
        self.create_service(AddTwoInts, "divide", self.divide)

    def multiply(self, request, response):
        response.sum = request.a * request.b
        return response

    def divide(self, request, response):
        if request.b:
            response.sum = request.a // request.b
        else:
            self.get_logger().error(f"cannot divide {request.a} by zero")
        return response


class Sums(Node):
    def __init__(self):
        super().__init__("sums")
        self.products = Products()
        self.create_service(AddTwoInts, "add", self.add)
        self.create_service(AddTwoInts, "subtract", self.subtract)

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

    def subtract(self, request, response):
        response.sum = request.a - request.b
        return response


def main():
    rclpy.init()
    sums = Sums()
    try:
        rclpy.spin(sums)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
