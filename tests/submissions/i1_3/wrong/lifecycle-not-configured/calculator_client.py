#!/usr/bin/env python3
import rclpy
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):
    def __init__(self):
        super().__init__("calculator_client")

    def calculate(self, service: str, a: int, b: int) -> int:
        client = self.create_client(AddTwoInts, service)
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().warning(f"Waiting for service '{service}'")
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future)
        self.destroy_client(client)
        return future.result().sum


def main(args=None) -> None:
    rclpy.init(args=args)
    node = CalculatorClient()
    node.get_logger().info(f"4 + 2 = {node.calculate('add', 4, 2)}")
    node.get_logger().info(f"4 - 2 = {node.calculate('subtract', 4, 2)}")
    node.get_logger().info(f"4 * 2 = {node.calculate('multiply', 4, 2)}")
    node.get_logger().info(f"4 / 2 = {node.calculate('divide', 4, 2)}")
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
