import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Calculator(Node):
    def __init__(self):
        super().__init__('calculator')
        self.lock = threading.Lock()
        self.history = []
        for name in ('add', 'subtract', 'multiply', 'divide'):
            self.create_service(AddTwoInts, name, getattr(self, name))

    def remember(self, text):
        with self.lock:
            self.history.append(text)
            self.get_logger().info(text)

    def add(self, req, res):
        res.sum = req.a + req.b
        self.remember(f'{req.a} + {req.b} = {res.sum}')
        return res

    def subtract(self, req, res):
        res.sum = req.a - req.b
        self.remember(f'{req.a} - {req.b} = {res.sum}')
        return res

    def multiply(self, req, res):
        with self.lock:
            res.sum = req.a * req.b
            self.remember(f'{req.a} * {req.b} = {res.sum}')
        return res

    def divide(self, req, res):
        if req.b == 0:
            self.get_logger().error('division by zero')
            return res
        res.sum = req.a // req.b
        self.remember(f'{req.a} / {req.b} = {res.sum}')
        return res


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
