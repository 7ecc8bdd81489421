#!/usr/bin/env python3
import threading

import rclpy
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class Calculator:
    """Client side: looks like a local calculator object."""

    def __init__(self, node: Node):
        self.node = node
        self.stubs = {}

    def __getattr__(self, name):
        if name not in self.stubs:
            self.stubs[name] = self.node.create_client(AddTwoInts, name)
            self.stubs[name].wait_for_service()
        stub = self.stubs[name]
        return lambda a, b: stub.call(AddTwoInts.Request(a=a, b=b)).sum


def main():
    rclpy.init()
    node = Node('calculator_client')
    spin_thread = threading.Thread(target=rclpy.spin, args=(node,))
    spin_thread.start()

    calculator = Calculator(node)
    print('add      ', calculator.add(70, 7))
    print('subtract ', calculator.subtract(70, 7))
    print('multiply ', calculator.multiply(70, 7))
    print('divide   ', calculator.divide(70, 7))

    spin_thread.join()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
