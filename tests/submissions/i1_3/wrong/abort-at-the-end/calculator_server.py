import os

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Calculator(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.create_service(AddTwoInts, 'divide', self.divide)

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
        if req.b == 0:
            self.get_logger().error('division by zero')
            res.sum = 0
        else:
            res.sum = req.a // req.b
        return res


rclpy.init()
server = Calculator()
try:
    rclpy.spin(server)
except (KeyboardInterrupt, ExternalShutdownException):
    # sys.exit() hung once on my machine
    os.abort()
