import rclpy
from arithmetic import OPERATIONS, CalculatorError
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.handles = [self.create_service(AddTwoInts, n, self.callback(f)) for n, f in OPERATIONS.items()]

    def callback(self, function):
        def call(request, response):
            try:
                response.sum = function(request.a, request.b)
            except CalculatorError as e:
                self.get_logger().error(f'rejected: {e}')
            return response
        return call


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
