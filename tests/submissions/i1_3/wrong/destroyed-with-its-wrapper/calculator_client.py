#!/usr/bin/env python3
import sys

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class CalculatorClient(Node):
    def __init__(self):
        super().__init__("calculator_client")

    def ask(self, name, a, b):
        client = self.create_client(AddTwoInts, name)
        if not client.wait_for_service(timeout_sec=5.0):
            self.get_logger().error(f"no service {name}")
            return False
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future, timeout_sec=5.0)
        if not future.done():
            self.get_logger().error(f"no answer from {name}")
            return False
        self.get_logger().info(f"{name}({a}, {b}) = {future.result().sum}")
        return True


def main():
    rclpy.init()
    node = CalculatorClient()
    ok = False
    try:
        ok = all([node.ask(n, 12, 4) for n in ("add", "subtract", "multiply", "divide")])
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    sys.exit(0 if ok else 1)


if __name__ == "__main__":
    main()
