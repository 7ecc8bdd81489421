#!/usr/bin/env python3
"""Calculator with multiple service endpoints."""

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')

        self.add_srv = self.create_service(
            AddTwoInts, 'add', self.add_callback
        )
        self.sub_srv = self.create_service(
            AddTwoInts, 'subtract', self.sub_callback
        )
        self.mul_srv = self.create_service(
            AddTwoInts, 'multiply', self.mul_callback
        )
        self.div_srv = self.create_service(
            AddTwoInts, 'divide', self.div_callback
        )

        self.get_logger().info('Calculator services ready')

    def add_callback(self, req, resp):
        resp.sum = req.a + req.b
        self.get_logger().info(f'{req.a} + {req.b} = {resp.sum}')
        return resp

    def sub_callback(self, req, resp):
        resp.sum = req.a - req.b
        self.get_logger().info(f'{req.a} - {req.b} = {resp.sum}')
        return resp

    def mul_callback(self, req, resp):
        resp.sum = req.a * req.b
        self.get_logger().info(f'{req.a} * {req.b} = {resp.sum}')
        return resp

    def div_callback(self, req, resp):
        if req.b == 0:
            self.get_logger().error('Division by zero!')
            resp.sum = 0 # Indicate error
        else:
            resp.sum = req.a // req.b # Integer division
            self.get_logger().info(f'{req.a} / {req.b} = {resp.sum}')
        return resp

def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
