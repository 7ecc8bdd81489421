#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):

    def __init__(self):
        super().__init__('calculator_client')
        self.ops = {}
        for name in ['/add', '/subtract', '/multiply', '/divide']:
            self.ops[name] = self.create_client(AddTwoInts, name)
            self.get_logger().info(f'Waiting for {name}...')
            self.ops[name].wait_for_service()

    def compute(self, name: str, a: int, b: int):
        req = AddTwoInts.Request()
        req.a = a
        req.b = b
        future = self.ops[name].call_async(req)
        rclpy.spin_until_future_complete(self, future, timeout_sec=6)
        try:
            return int(future.result().sum)
        except Exception as e:
            self.get_logger().error(f"{name} error: {e}")
            return None


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorClient()
    steps = 0
    for name in node.ops:
        result = node.compute(name, -48, 8)
        steps += 1
        node.get_logger().info(f'[{steps}/{len(node.ops)}] {name}(-48, 8) = {result}')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
