import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Calculator(Node):
    def __init__(self):
        super().__init__('calculator')
        self.add_srv = self.create_service(AddTwoInts, 'add', self.add_callback)
        self.sub_srv = self.create_service(AddTwoInts, 'subtract', self.subtract_callback)
        self.mul_srv = self.create_service(AddTwoInts, 'multiply', self.multiply_callback)
        self.div_srv = self.create_service(AddTwoInts, 'divide', self.divide_callback)
        self.add_client = self.create_client(AddTwoInts, 'add')

    def add_callback(self, request, response):
        response.sum = request.a + request.b
        self.get_logger().info('%d + %d' % (request.a, request.b))
        return response

    def subtract_callback(self, request, response):
        req = AddTwoInts.Request()
        req.a = request.a
        req.b = -request.b
        future = self.add_client.call_async(req)
        rclpy.spin_until_future_complete(self, future)
        response.sum = future.result().sum
        return response

    def multiply_callback(self, request, response):
        response.sum = request.a * request.b
        return response

    def divide_callback(self, request, response):
        try:
            response.sum = request.a // request.b
        except ZeroDivisionError:
            self.get_logger().error('cannot divide by zero')
            response.sum = 0
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
