import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')
        self.names = ['add', 'subtract', 'multiply', 'divide']
        self.timer = self.create_timer(0.5, self.tick)

    def tick(self):
        if not self.names:
            raise SystemExit
        client = self.create_client(AddTwoInts, self.names.pop(0))
        client.wait_for_service()
        answer = client.call(AddTwoInts.Request(a=8, b=2))
        self.get_logger().info(f'answer: {answer.sum}')


rclpy.init()
try:
    rclpy.spin(CalculatorClient())
except SystemExit:
    pass
rclpy.shutdown()
