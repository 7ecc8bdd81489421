#!/usr/bin/python3

# ros-related
import rclpy
from rclpy.node import Node

# common-python
from functools import partial
import operator

# interface
from example_interfaces.srv import AddTwoInts


class CalculatorServerNode(Node):
    def __init__(self) -> None:
        super().__init__("calculator_server")

        # variables
        self.request_counter_ = 0

        # services
        self.add_service_ = self.create_service(
            AddTwoInts, "add", partial(self.callback_calculate, operator.add))
        self.subtract_service_ = self.create_service(
            AddTwoInts, "subtract", partial(self.callback_calculate, operator.sub))
        self.multiply_service_ = self.create_service(
            AddTwoInts, "multiply", partial(self.callback_calculate, operator.mul))
        self.divide_service_ = self.create_service(
            AddTwoInts, "divide", partial(self.callback_calculate, operator.floordiv))

        self.get_logger().info("Calculator server has been started.")

    def callback_calculate(self, request, response, function) -> AddTwoInts.Response:
        self.request_counter_ += 1
        try:
            response.sum = function(request.a, request.b)
        except ZeroDivisionError:
            self.get_logger().error(f"Request {self.request_counter_}: division by zero!")
            response.sum = 0
        return response


def main(args=None) -> None:
    rclpy.init(args=args)
    node = CalculatorServerNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
