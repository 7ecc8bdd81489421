#!/usr/bin/env python3
import rclpy
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class REMOTE(Node):

    def __init__(self):
        super().__init__('calculator_remote')

    def init(self):
        self._add = self.create_client(AddTwoInts, 'add')
        self._subtract = self.create_client(AddTwoInts, 'subtract')
        self._multiply = self.create_client(AddTwoInts, 'multiply')
        self._divide = self.create_client(AddTwoInts, 'divide')
        for client in (self._add, self._subtract, self._multiply, self._divide):
            while not client.wait_for_service(timeout_sec=0.5):
                self.get_logger().info('waiting for ' + client.srv_name)

    def _request(self, client, a, b):
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future)
        return future.result().sum

    def add(self, a, b):
        return self._request(self._add, a, b)

    def subtract(self, a, b):
        return self._request(self._subtract, a, b)

    def multiply(self, a, b):
        return self._request(self._multiply, a, b)

    def divide(self, a, b):
        return self._request(self._divide, a, b)


if __name__ == '__main__':
    rclpy.init()
    remote = REMOTE()
    remote.init()
    print(f'30 + 12 = {remote.add(30, 12)}')
    print(f'30 - 12 = {remote.subtract(30, 12)}')
    print(f'30 * 12 = {remote.multiply(30, 12)}')
    print(f'36 / 12 = {remote.divide(36, 12)}')
    remote.destroy_node()
    rclpy.shutdown()
