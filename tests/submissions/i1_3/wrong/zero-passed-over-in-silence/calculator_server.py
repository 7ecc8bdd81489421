import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class Calculator(Node):
    def __init__(self):
        super().__init__('calculator')
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.create_service(AddTwoInts, 'divide', self.divide)
        self.get_logger().info('ready')

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

    def subtract(self, request, response):
        response.sum = request.a - request.b
        return response

    def multiply(self, request, response):
        response.sum = request.a * request.b
        return response

    def divide(self, request, response):
        response.sum = 0
        try:
            response.sum = request.a // request.b
        except:
            pass
        return response


def main():
    rclpy.init()
    node = Calculator()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.get_logger().info('bye')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
