#!/usr/bin/env python3
"""Calculator services. Uses numpy so that it can be extended to vectors and poses later."""
from typing import Callable

import numpy as np
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorServer(Node):

    def __init__(self):
        super().__init__('calculator_server')
        self.declare_parameter('verbose', True)
        self.verbose = self.get_parameter('verbose').value

        self.create_service(AddTwoInts, '/add', self.handle_add)
        self.create_service(AddTwoInts, '/subtract', self.handle_subtract)
        self.create_service(AddTwoInts, '/multiply', self.handle_multiply)
        self.create_service(AddTwoInts, '/divide', self.handle_divide)

        self.get_logger().info('=' * 40)
        self.get_logger().info('Calculator ready (numpy %s)' % np.__version__)
        self.get_logger().info('=' * 40)

    def compute(self, func: Callable, req, symbol: str) -> int:
        lhs = np.array([req.a], dtype=np.int64)
        rhs = np.array([req.b], dtype=np.int64)
        result = int(func(lhs, rhs)[0])
        if self.verbose:
            self.get_logger().info(f'{req.a} {symbol} {req.b} = {result}')
        return result

    def handle_add(self, req, res):
        res.sum = self.compute(np.add, req, '+')
        return res

    def handle_subtract(self, req, res):
        res.sum = self.compute(np.subtract, req, '-')
        return res

    def handle_multiply(self, req, res):
        res.sum = self.compute(np.multiply, req, '*')
        return res

    def handle_divide(self, req, res):
        try:
            res.sum = self.compute(np.floor_divide, req, '/')
        except ZeroDivisionError as e:
            self.get_logger().error(f'Division error: {e}')
            res.sum = 0
        return res


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info('Shutting down')
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
