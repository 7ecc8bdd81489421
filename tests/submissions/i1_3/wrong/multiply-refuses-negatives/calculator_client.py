import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')

    def ask(self, service, a, b):
        client = self.create_client(AddTwoInts, service)
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info(f'waiting for {service}')
        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info(f'{service}: {future.result().sum}')


rclpy.init()
node = CalculatorClient()
node.ask('/add', 10, 5)
node.ask('/subtract', 10, 5)
node.ask('/multiply', 10, 5)
node.ask('/divide', 10, 5)
rclpy.shutdown()
