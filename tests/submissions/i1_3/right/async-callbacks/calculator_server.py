import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.create_service(AddTwoInts, 'divide', self.divide)

    async def add(self, request, response):
        response.sum = request.a + request.b
        return response

    async def subtract(self, request, response):
        response.sum = request.a - request.b
        return response

    async def multiply(self, request, response):
        response.sum = request.a * request.b
        return response

    async def divide(self, request, response):
        if not request.b:
            self.get_logger().get_child('divide').error('the divisor must not be 0')
            return response
        response.sum = round(request.a / request.b)
        return response


def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
