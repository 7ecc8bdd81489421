import operator

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class OperationNode(Node):
    def __init__(self, name, function):
        super().__init__(name + '_node')
        self.function = function
        self.create_service(AddTwoInts, name, self.serve)

    def serve(self, request, response):
        try:
            response.sum = self.function(request.a, request.b)
        except ArithmeticError as error:
            self.get_logger().error(f'{request.a} and {request.b}: {error}')
        return response


def main():
    rclpy.init()
    executor = MultiThreadedExecutor()
    nodes = [
        OperationNode('add', operator.add),
        OperationNode('subtract', operator.sub),
        OperationNode('multiply', operator.mul),
        OperationNode('divide', operator.floordiv),
    ]
    for node in nodes:
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        for node in nodes:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
