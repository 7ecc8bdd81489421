#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorTest(Node):
    def __init__(self):
        super().__init__('calculator_test')
        self.add = self.create_client(AddTwoInts, '/add')
        self.subtract = self.create_client(AddTwoInts, '/subtract')
        self.multiply = self.create_client(AddTwoInts, '/multiply')
        self.divide = self.create_client(AddTwoInts, '/divide')

    def send(self, client, a, b):
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('%s not available, waiting again...' % client.srv_name)
        req = AddTwoInts.Request()
        req.a = a
        req.b = b
        future = client.call_async(req)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info('%s %d %d: %d' % (client.srv_name, a, b, future.result().sum))


def main(args=None):
    rclpy.init(args=args)
    test = CalculatorTest()
    test.send(test.add, 5, 3)
    test.send(test.subtract, 5, 3)
    test.send(test.multiply, 5, 3)
    test.send(test.divide, 6, 3)
    test.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
