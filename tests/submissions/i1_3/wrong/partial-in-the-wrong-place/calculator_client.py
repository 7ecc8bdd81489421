#!/usr/bin/python3

import rclpy
from rclpy.node import Node

from functools import partial

from example_interfaces.srv import AddTwoInts


class CalculatorClientNode(Node):
    def __init__(self) -> None:
        super().__init__("calculator_client")
        self.open_calls_ = 0
        for name in ("add", "subtract", "multiply", "divide"):
            self.call_server(name, 30, -5)

    def call_server(self, name: str, a: int, b: int) -> None:
        client = self.create_client(AddTwoInts, name)
        while not client.wait_for_service(1.0):
            self.get_logger().warn(f"Waiting for server {name}...")

        request = AddTwoInts.Request()
        request.a = a
        request.b = b

        self.open_calls_ += 1
        future = client.call_async(request)
        future.add_done_callback(partial(self.callback_answer, name=name, a=a, b=b))

    def callback_answer(self, future, name, a, b) -> None:
        self.open_calls_ -= 1
        self.get_logger().info(f"{name}({a}, {b}): {future.result().sum}")


def main(args=None) -> None:
    rclpy.init(args=args)
    node = CalculatorClientNode()
    while node.open_calls_ > 0:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
