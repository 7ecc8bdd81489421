import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts

class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.sub)
        self.create_service(AddTwoInts, 'multiply', self.mul)
        self.create_service(AddTwoInts, 'divide', self.div)
        self.get_logger().info('ready')

    def add(self, req, res):
        res.sum = req.a + req.b
        self.get_logger().info(f'{req.a} + {req.b} = {res.sum}')
        return res

    def sub(self, req, res):
        res.sum = req.a - req.b
        self.get_logger().info(f'{req.a} - {req.b} = {res.sum}')
        return res

    def mul(self, req, res):
        res.sum = req.a * req.b
        self.get_logger().info(f'{req.a} * {req.b} = {res.sum}')
        return res

    def div(self, req, res):
        if req.b == 0:
            self.get_logger().error('Division by zero!')
            res.sum = 0
        else:
            res.sum = req.a // req.b
            self.get_logger().info(f'{req.a} / {req.b} = {res.sum}')
        return res

def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()

if __name__ == '__main__':
    main()
