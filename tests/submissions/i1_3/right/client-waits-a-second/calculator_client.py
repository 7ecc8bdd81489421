import sys

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')

    def call(self, name, a, b):
        client = self.create_client(AddTwoInts, name)
        if not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().error(f'{name} not available')
            sys.exit(1)
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future)
        return future.result().sum


def main():
    rclpy.init()
    node = CalculatorClient()
    print(node.call('add', 1, 2), node.call('subtract', 5, 3), node.call('multiply', 4, -2), node.call('divide', 9, 3))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
