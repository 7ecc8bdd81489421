import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        for op in '+-*/':
            name = {'+': 'add', '-': 'subtract', '*': 'multiply', '/': 'divide'}[op]
            self.create_service(AddTwoInts, name, self.make(op))

    def make(self, op):
        def callback(req, res):
            a, b = req.a, req.b
            if op == '/' and b == 0:
                self.get_logger().error(f'{a} / {b}: division by zero!')
            elif op == '/':
                res.sum = a // b
            else:
                res.sum = {'+': a + b, '-': a - b, '*': a * b}[op]
            return res
        return callback


if __name__ == '__main__':
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()
