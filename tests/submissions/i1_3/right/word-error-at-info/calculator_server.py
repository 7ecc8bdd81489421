import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.make('add', '+')
        self.make('subtract', '-')
        self.make('multiply', '*')
        self.make('divide', '/')

    def make(self, name, sign):
        def cb(req, resp):
            a, b = req.a, req.b
            if sign == '/' and b == 0:
                self.get_logger().info('ERROR: division by zero')
                resp.sum = 0
            else:
                resp.sum = {'+': a + b, '-': a - b, '*': a * b, '/': a // (b or 1)}[sign]
            self.get_logger().info(f'{a} {sign} {b} = {resp.sum}')
            return resp
        self.create_service(AddTwoInts, name, cb)


if __name__ == '__main__':
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()
