#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')

    def demo(self):
        for name in ('add', 'subtract', 'multiply', 'divide'):
            client = self.create_client(AddTwoInts, name)
            client.wait_for_service()
            future = client.call_async(AddTwoInts.Request(a=18, b=3))
            rclpy.spin_until_future_complete(self, future)
            self.get_logger().info(f'{name}: {future.result().sum}')


def main():
    rclpy.init()
    node = CalculatorClient()
    try:
        node.demo()
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
