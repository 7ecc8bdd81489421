"""One table of operations, with one check of the operands for all of them."""

import operator

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

OPERATIONS = {
    "add": operator.add,
    "subtract": operator.sub,
    "multiply": operator.mul,
    "divide": operator.floordiv,
}


class Calculator(Node):
    def __init__(self):
        super().__init__("calculator_server")
        for name in OPERATIONS:
            self.create_service(AddTwoInts, name, self.answer_with(name))

    def answer_with(self, name):
        def answer(request, response):
            if not self.is_valid(request):
                self.get_logger().error(f"{name}({request.a}, {request.b}): zero is not allowed")
                return response
            response.sum = OPERATIONS[name](request.a, request.b)
            self.get_logger().info(f"{name}({request.a}, {request.b}) = {response.sum}")
            return response

        return answer

    def is_valid(self, request):
        return request.b != 0


def main():
    rclpy.init()
    node = Calculator()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
