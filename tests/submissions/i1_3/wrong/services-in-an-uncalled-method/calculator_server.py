#!/usr/bin/env python3
"""
CALCULATOR interface for the leg board.

    calc = CALCULATOR()
    calc.init()          # opens the services
    rclpy.spin(calc)
"""
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class CALCULATOR(Node):

    def __init__(self, node_name='calculator_server'):
        super().__init__(node_name)
        self.services_open = False
        self.num_errors = 0
        self.get_logger().info('calculator node up')

    def init(self):
        """Create all services. Kept apart from the constructor so that scripts can subclass."""
        self._srv_add = self.create_service(AddTwoInts, 'add', self.add)
        self._srv_subtract = self.create_service(AddTwoInts, 'subtract', self.subtract)
        self._srv_multiply = self.create_service(AddTwoInts, 'multiply', self.multiply)
        self._srv_divide = self.create_service(AddTwoInts, 'divide', self.divide)
        self.services_open = True
        self.get_logger().info('calculator services open')

    def add(self, req, res):
        res.sum = req.a + req.b
        return res

    def subtract(self, req, res):
        res.sum = req.a - req.b
        return res

    def multiply(self, req, res):
        res.sum = req.a * req.b
        return res

    def divide(self, req, res):
        if req.b != 0:
            res.sum = req.a // req.b
        else:
            self.num_errors += 1
            self.get_logger().error('divide: b is zero, returning 0')
            res.sum = 0
        return res


def main():
    rclpy.init()
    calc = CALCULATOR()
    try:
        rclpy.spin(calc)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        calc.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
