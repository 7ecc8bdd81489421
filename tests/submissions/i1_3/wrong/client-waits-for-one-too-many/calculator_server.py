#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts


class CalculatorPatterns(Node):
    """service names on the left, verbs on the right"""

    NAMES = {'add': 'plus', 'subtract': 'minus', 'multiply': 'times', 'divide': 'over'}

    def __init__(self):
        super().__init__('calculator_server')
        self.srvs = []
        for name, verb in self.NAMES.items():
            self.srvs.append(self.create_service(AddTwoInts, name, self.make_cb(verb)))

    def make_cb(self, verb):
        def cb(req, resp):
            if verb == 'over' and req.b == 0:
                self.get_logger().error('{} over zero is undefined'.format(req.a))
                resp.sum = 0
                return resp
            resp.sum = {
                'plus': lambda: req.a + req.b,
                'minus': lambda: req.a - req.b,
                'times': lambda: req.a * req.b,
                'over': lambda: req.a // req.b,
            }[verb]()
            print("{} {} {} is {}".format(req.a, verb, req.b, resp.sum))
            return resp
        return cb


if __name__ == '__main__':
    rclpy.init()
    node = CalculatorPatterns()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
