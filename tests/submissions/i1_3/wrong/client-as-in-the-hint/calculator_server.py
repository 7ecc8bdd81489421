import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class Calculator(Node):
    def __init__(self):
        super().__init__("calculator")
        for name in ("add", "subtract", "multiply", "divide"):
            self.create_service(AddTwoInts, name, getattr(self, name))

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

    def subtract(self, request, response):
        response.sum = request.a - request.b
        return response

    def multiply(self, request, response):
        response.sum = request.a * request.b
        return response

    def divide(self, request, response):
        try:
            response.sum = request.a // request.b
        except ZeroDivisionError:
            self.get_logger().error(f"{request.a} / 0: division by zero")
        return response


def main():
    rclpy.init()
    node = Calculator()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
