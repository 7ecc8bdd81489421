#!/usr/bin/env python3
import sys

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorServiceClient(Node):

    def __init__(self):
        super().__init__('calculator_service_client')
        self.cli = {}
        for name in ('add', 'subtract', 'multiply', 'divide'):
            self.cli[name] = self.create_client(AddTwoInts, name)
            while not self.cli[name].wait_for_service(timeout_sec=1.0):
                self.get_logger().info('Service not available, waiting...')
        self.req = AddTwoInts.Request()

    def send_request(self, name, a, b):
        self.req.a = a
        self.req.b = b
        self.future = self.cli[name].call_async(self.req)
        rclpy.spin_until_future_complete(self, self.future)
        return self.future.result()


def main(args=None):
    rclpy.init(args=args)
    if len(sys.argv) != 3:
        node = rclpy.create_node('calculator_service_client_error')
        node.get_logger().info('Usage: python3 calculator_client.py <int> <int>')
        rclpy.shutdown()
        sys.exit(1)

    client = CalculatorServiceClient()
    a, b = int(sys.argv[1]), int(sys.argv[2])
    for name in client.cli:
        response = client.send_request(name, a, b)
        if response:
            client.get_logger().info(f'Result of {name}: {response.sum}')
        else:
            client.get_logger().error('Service call failed.')
    client.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
