#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')
        self.names = ['add', 'subtract', 'multiply', 'divide']
        self.ops = {name: self.create_client(AddTwoInts, name) for name in self.names}

    def wait(self):
        for name in self.names:
            if not self.ops[name].wait_for_service(timeout_sec=10.0):
                raise RuntimeError(f'/{name} is missing')

    def call(self, name, a, b):
        future = self.ops[name].call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future, timeout_sec=5.0)
        if future.result() is None:
            raise RuntimeError(f'/{name} did not answer')
        self.get_logger().info(f'{name} {a} {b}: {future.result().sum}')


def main():
    rclpy.init()
    node = CalculatorClient()
    node.wait()
    for name in node.names:
        node.call(name, 100, 4)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
