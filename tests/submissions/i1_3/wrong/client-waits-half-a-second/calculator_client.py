import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')
        self.cli = self.create_client(AddTwoInts, 'add')
        self.cli.wait_for_service(timeout_sec=0.5)
        self.others = [self.create_client(AddTwoInts, n) for n in ('subtract', 'multiply', 'divide')]

    def ask(self, client, a, b):
        self.future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, self.future, timeout_sec=3.0)
        return self.future.result()


def main():
    rclpy.init()
    node = CalculatorClient()
    for client in [node.cli] + node.others:
        answer = node.ask(client, 30, 6)
        node.get_logger().info(f'{client.srv_name}: {answer.sum}')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
