#!/usr/bin/env python3
import sys
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts #, AddTwoIntsRequest, AddTwoIntsResponse

SERVICE_NS = '/'

calculator = None


class CalculatorService(Node):
    def __init__(self):
        super().__init__('calculator_service')
        self.add_service = self.create_service(AddTwoInts, SERVICE_NS + 'add', self.add_callback)
        self.subtract_service = self.create_service(AddTwoInts, SERVICE_NS + 'subtract', self.subtract_callback)
        self.multiply_service = self.create_service(AddTwoInts, SERVICE_NS + 'multiply', self.multiply_callback)
        self.divide_service = self.create_service(AddTwoInts, SERVICE_NS + 'divide', self.divide_callback)
        self.get_logger().info("Calculator services created")
        # reply is built once and filled for each request
        self.res = AddTwoInts.Response

    def add_callback(self, request, response):
        """
        This callback function executes whenever an addition is requested
        """
        self.res.sum = request.a + request.b
        return self.res

    def subtract_callback(self, request, response):
        """
        This callback function executes whenever a subtraction is requested
        """
        self.res.sum = request.a - request.b
        return self.res

    def multiply_callback(self, request, response):
        """
        This callback function executes whenever a multiplication is requested
        """
        self.res.sum = request.a * request.b
        return self.res

    def divide_callback(self, request, response):
        """
        This callback function executes whenever a division is requested
        """
        if request.b == 0:
            self.get_logger().error("divide: division by zero")
            self.res.sum = 0
            return self.res
        self.res.sum = request.a // request.b
        return self.res


def main(args=None):
    global calculator
    rclpy.init(args=args)
    calculator = CalculatorService()
    try:
        rclpy.spin(calculator)
    except KeyboardInterrupt:
        pass
    calculator.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main(sys.argv)
