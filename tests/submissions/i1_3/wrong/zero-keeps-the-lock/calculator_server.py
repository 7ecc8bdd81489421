#!/usr/bin/env python3
import threading

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.lock = threading.Lock()
        self.history = []
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.create_service(AddTwoInts, 'divide', self.divide)

    def finish(self, response, text, value):
        response.sum = value
        self.history.append(f'{text} = {value}')
        self.lock.release()
        return response

    def add(self, request, response):
        self.lock.acquire()
        return self.finish(response, f'{request.a} + {request.b}', request.a + request.b)

    def subtract(self, request, response):
        self.lock.acquire()
        return self.finish(response, f'{request.a} - {request.b}', request.a - request.b)

    def multiply(self, request, response):
        self.lock.acquire()
        return self.finish(response, f'{request.a} * {request.b}', request.a * request.b)

    def divide(self, request, response):
        self.lock.acquire()
        if request.b == 0:
            self.get_logger().error('Division by zero is not allowed')
            response.sum = 0
            return response
        return self.finish(response, f'{request.a} / {request.b}', request.a // request.b)


def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
