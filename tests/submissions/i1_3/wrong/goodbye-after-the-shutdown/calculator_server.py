#!/usr/bin/env python3
import time
from collections import Counter

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from example_interfaces.srv import AddTwoInts


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.counts = Counter()
        self.report = self.create_publisher(String, 'calculator/report', 10)
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.create_service(AddTwoInts, 'divide', self.divide)

    def add(self, req, resp):
        self.counts['add'] += 1
        resp.sum = req.a + req.b
        return resp

    def subtract(self, req, resp):
        self.counts['subtract'] += 1
        resp.sum = req.a - req.b
        return resp

    def multiply(self, req, resp):
        self.counts['multiply'] += 1
        resp.sum = req.a * req.b
        return resp

    def divide(self, req, resp):
        self.counts['divide'] += 1
        if req.b == 0:
            self.get_logger().error('division by zero')
            return resp
        resp.sum = req.a // req.b
        return resp

    def say_goodbye(self):
        time.sleep(0.5)     # give the last caller time to get its answer
        self.report.publish(String(data=f'closing after {dict(self.counts)}'))


def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.say_goodbye()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
