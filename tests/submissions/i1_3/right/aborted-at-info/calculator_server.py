#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts

class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.s1 = self.create_service(AddTwoInts, 'add', self.add_cb)
        self.s2 = self.create_service(AddTwoInts, 'subtract', self.sub_cb)
        self.s3 = self.create_service(AddTwoInts, 'multiply', self.mul_cb)
        self.s4 = self.create_service(AddTwoInts, 'divide', self.div_cb)

    def add_cb(self, req, resp):
        resp.sum = req.a + req.b
        return resp

    def sub_cb(self, req, resp):
        resp.sum = req.a - req.b
        return resp

    def mul_cb(self, req, resp):
        resp.sum = req.a * req.b
        return resp

    def div_cb(self, req, resp):
        if req.b == 0:
            self.get_logger().info('Operation aborted (b=0)')
            resp.sum = 0
        else:
            resp.sum = req.a // req.b
        return resp

def main():
    rclpy.init()
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
