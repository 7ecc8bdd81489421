#!/usr/bin/env python3
import queue
import threading

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.jobs = queue.Queue()
        self.result = 0
        threading.Thread(target=self.work, daemon=True).start()
        for name in ('add', 'subtract', 'multiply', 'divide'):
            self.create_service(AddTwoInts, name, self.make_callback(name))

    def make_callback(self, name):
        def callback(request, response):
            if name == 'divide' and request.b == 0:
                self.get_logger().error('division by zero')
                response.sum = 0
                return response
            # never compute in a callback!
            response.sum = self.result
            self.jobs.put((name, request.a, request.b))
            return response
        return callback

    def work(self):
        while True:
            name, a, b = self.jobs.get()
            if name == 'add':
                self.result = a + b
            elif name == 'subtract':
                self.result = a - b
            elif name == 'multiply':
                self.result = a * b
            else:
                self.result = a // b


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
