import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')
        self.response_received = threading.Event()

    def send_request(self, operation, a, b):
        client = self.create_client(AddTwoInts, operation)
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info(f'waiting for {operation} ...')
        self.future = client.call_async(AddTwoInts.Request(a=a, b=b))
        self.response_received.wait()
        return self.future.result()


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorClient()
    spin_thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spin_thread.start()
    for operation in ('add', 'subtract', 'multiply', 'divide'):
        result = node.send_request(operation, 20, 5)
        node.get_logger().info(f'{operation}(20, 5) = {result.sum}')
    rclpy.shutdown()
    spin_thread.join()


if __name__ == '__main__':
    main()
