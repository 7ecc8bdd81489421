import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')
        self.add_client = self.create_client(AddTwoInts, 'add')
        self.subtract_client = self.create_client(AddTwoInts, 'subtract')
        self.multiply_client = self.create_client(AddTwoInts, 'multiply')
        self.divide_client = self.create_client(AddTwoInts, 'divide')

    def send(self, client, a, b):
        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        return future.result().sum


def main():
    rclpy.init()
    node = CalculatorClient()
    print('10 + 5 =', node.send(node.add_client, 10, 5))
    print('10 - 5 =', node.send(node.subtract_client, 10, 5))
    print('10 * 5 =', node.send(node.multiply_client, 10, 5))
    print('10 / 5 =', node.send(node.divide_client, 10, 5))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
