import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.create_service(AddTwoInts, 'calculate', self.calculate)

    def calculate(self, req, resp):
        # a = operation * 1000 + operand
        operation, a = divmod(req.a, 1000)
        if operation == 3 and req.b == 0:
            self.get_logger().error('division by zero')
            return resp
        resp.sum = [a + req.b, a - req.b, a * req.b, a // (req.b or 1)][operation]
        return resp


def main():
    rclpy.init()
    try:
        rclpy.spin(CalculatorServer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
