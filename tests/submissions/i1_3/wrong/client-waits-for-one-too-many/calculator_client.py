#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClientAsync(Node):

    def __init__(self):
        super().__init__('calculator_client')
        self.names = ['add', 'subtract', 'multiply', 'divide']
        self.client_futures = []
        self.received = 0

    def send_all(self, a, b):
        for name in self.names:
            client = self.create_client(AddTwoInts, name)
            client.wait_for_service()
            self.client_futures.append((name, client.call_async(AddTwoInts.Request(a=a, b=b))))

    def spin(self):
        while rclpy.ok() and self.received <= len(self.names):
            rclpy.spin_once(self, timeout_sec=0.1)
            incomplete_futures = []
            for name, f in self.client_futures:
                if f.done():
                    self.received += 1
                    print("received {} result: {}".format(name, f.result().sum))
                else:
                    incomplete_futures.append((name, f))
            self.client_futures = incomplete_futures


if __name__ == '__main__':
    rclpy.init()
    node = CalculatorClientAsync()
    node.send_all(100, 25)
    node.spin()
    node.destroy_node()
    rclpy.shutdown()
