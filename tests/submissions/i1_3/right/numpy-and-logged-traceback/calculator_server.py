#!/usr/bin/env python3
import traceback

import numpy as np
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class Operation:
    """A callable object per service."""

    def __init__(self, node, name, ufunc):
        self.logger = node.get_logger()
        self.name = name
        self.ufunc = ufunc

    def __call__(self, request, response):
        try:
            with np.errstate(all='raise'):
                response.sum = int(self.ufunc(np.int64(request.a), np.int64(request.b)))
        except FloatingPointError:
            self.logger.error(f'/{self.name} failed\n{traceback.format_exc()}')
            response.sum = 0
        return response


class NumpyCalculator(Node):
    def __init__(self):
        super().__init__('numpy_calculator')
        self.operations = []
        for name, ufunc in [
            ('add', np.add),
            ('subtract', np.subtract),
            ('multiply', np.multiply),
            ('divide', np.floor_divide),
        ]:
            operation = Operation(self, name, ufunc)
            self.operations.append(operation)
            self.create_service(AddTwoInts, name, operation)


def main():
    rclpy.init()
    node = NumpyCalculator()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
