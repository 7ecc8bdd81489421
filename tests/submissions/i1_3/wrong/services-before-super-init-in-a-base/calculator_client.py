#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):

    def __init__(self):
        super().__init__('calculator_client')
        self.add_cli = self.create_client(AddTwoInts, 'add')
        self.sub_cli = self.create_client(AddTwoInts, 'subtract')
        self.mul_cli = self.create_client(AddTwoInts, 'multiply')
        self.div_cli = self.create_client(AddTwoInts, 'divide')
        for cli in (self.add_cli, self.sub_cli, self.mul_cli, self.div_cli):
            while not cli.wait_for_service(timeout_sec=1.0):
                self.get_logger().info(f'{cli.srv_name} 서비스를 기다리는 중...')

    # 요청 보내기
    def send(self, cli, a, b):
        req = AddTwoInts.Request()
        req.a, req.b = a, b
        future = cli.call_async(req)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info(f'{cli.srv_name}: {a}, {b} -> {future.result().sum}')


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorClient()
    node.send(node.add_cli, 10, 3)
    node.send(node.sub_cli, 10, 3)
    node.send(node.mul_cli, 10, 3)
    node.send(node.div_cli, 12, 3)
    node.send(node.div_cli, 12, 0)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
