import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Calculator(Node):
    def __init__(self):
        super().__init__('calculator')
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.create_service(AddTwoInts, 'divide', self.divide)
        self.adder = self.create_client(AddTwoInts, 'add')

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

    async def subtract(self, request, response):
        # a - b is a + (-b), so let /add do the work
        negated = AddTwoInts.Request(a=request.a, b=-request.b)
        result = await self.adder.call_async(negated)
        response.sum = result.sum
        return response

    def multiply(self, request, response):
        response.sum = request.a * request.b
        return response

    def divide(self, request, response):
        if request.b == 0:
            self.get_logger().error('Division by zero!')
            response.sum = 0
            return response
        response.sum = request.a // request.b
        return response


def main():
    rclpy.init()
    node = Calculator()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
