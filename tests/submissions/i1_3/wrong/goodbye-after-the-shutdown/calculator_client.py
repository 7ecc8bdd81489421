#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')

    async def run(self, done):
        for name in ('add', 'subtract', 'multiply', 'divide'):
            client = self.create_client(AddTwoInts, name)
            client.wait_for_service()
            answer = await client.call_async(AddTwoInts.Request(a=48, b=12))
            self.get_logger().info(f'{name}: {answer.sum}')
        done.set_result(True)


def main():
    rclpy.init()
    node = CalculatorClient()
    executor = rclpy.get_global_executor()
    done = rclpy.Future()
    executor.create_task(node.run, done)
    rclpy.spin_until_future_complete(node, done)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
