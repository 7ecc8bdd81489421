import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')

    def run(self):
        for name in ('add', 'subtract', 'multiply', 'divide'):
            client = self.create_client(AddTwoInts, name)
            if not client.wait_for_service(timeout_sec=5.0):
                return False
            future = client.call_async(AddTwoInts.Request(a=10, b=5))
            rclpy.spin_until_future_complete(self, future, timeout_sec=5.0)
            self.get_logger().info(f'{name}: {future.result().sum}')
            return True


def main():
    rclpy.init()
    node = CalculatorClient()
    node.run()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
