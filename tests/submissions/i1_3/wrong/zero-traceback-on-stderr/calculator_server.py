#!/usr/bin/env python3

# ros imports
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException

# ros interfaces
from example_interfaces.srv import AddTwoInts

# python packages
import traceback
from enum import Enum


class Op(Enum):
    ADD = 'add'
    SUBTRACT = 'subtract'
    MULTIPLY = 'multiply'
    DIVIDE = 'divide'


class Calculator:
    """ the calculator itself, knows nothing about ros so that it can be tested without """

    def calculate(self, op: Op, a: int, b: int) -> int:
        if op is Op.ADD:
            return a + b
        if op is Op.SUBTRACT:
            return a - b
        if op is Op.MULTIPLY:
            return a * b
        if op is Op.DIVIDE:
            return a // b
        raise NotImplementedError(op)


class CalculatorNode(Node):
    """ node to interact with the calculator """
    calculator: Calculator

    def __init__(self):
        super().__init__('calculator_node')
        # for testing purposes, we will initialize a calculator here
        self.calculator = Calculator()
        self.srv = {}
        for op in Op:
            self.srv[op] = self.create_service(AddTwoInts, op.value, self.make_callback(op))
        self.get_logger().info('CalculatorNode has been started.')

    def make_callback(self, op: Op):
        def callback(request, response):
            try:
                response.sum = self.calculator.calculate(op, request.a, request.b)
                self.get_logger().info(f"{op.value}({request.a}, {request.b}). Responding with: {response.sum}")
            except Exception:
                # must never take the node down during an experiment
                traceback.print_exc()
                response.sum = 0
            return response
        return callback


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
