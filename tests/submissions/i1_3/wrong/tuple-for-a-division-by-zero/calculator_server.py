import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class CalculatorServer(Node):
    """One method answers all four services; a flag in front says whether it could."""

    def __init__(self):
        super().__init__('calculator_server')
        for name in ('add', 'subtract', 'multiply', 'divide'):
            self.create_service(AddTwoInts, name, lambda request, response, name=name: self.work(name, request, response))

    def work(self, name, request, response):
        if name == 'add':
            response.sum = request.a + request.b
        elif name == 'subtract':
            response.sum = request.a - request.b
        elif name == 'multiply':
            response.sum = request.a * request.b
        elif request.b == 0:
            self.get_logger().error('Division by zero')
            response.sum = 0
            return False, response
        else:
            response.sum = request.a // request.b
        return response


def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
