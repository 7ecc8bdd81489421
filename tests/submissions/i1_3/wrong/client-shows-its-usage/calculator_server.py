#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class cal():
    def __init__(self,a,b):
        self.a=a
        self.b=b
    def add(self):
        return self.a+self.b
    def mul(self):
        return self.a*self.b
    def div(self):
        return self.a//self.b
    def sub(self):
        return self.a-self.b

class CalculatorServiceServer(Node):

    def __init__(self):
        super().__init__('calculator_service_server')
        self.srv_add = self.create_service(AddTwoInts, 'add', self.add_service)
        self.srv_sub = self.create_service(AddTwoInts, 'subtract', self.sub_service)
        self.srv_mul = self.create_service(AddTwoInts, 'multiply', self.mul_service)
        self.srv_div = self.create_service(AddTwoInts, 'divide', self.div_service)

    def add_service(self, request, response):
        obj=cal(request.a,request.b)
        self.get_logger().info('operation %d + %d' % (request.a, request.b))
        response.sum = obj.add()
        return response

    def sub_service(self, request, response):
        obj=cal(request.a,request.b)
        self.get_logger().info('operation %d - %d' % (request.a, request.b))
        response.sum = obj.sub()
        return response

    def mul_service(self, request, response):
        obj=cal(request.a,request.b)
        self.get_logger().info('operation %d * %d' % (request.a, request.b))
        response.sum = obj.mul()
        return response

    def div_service(self, request, response):
        obj=cal(request.a,request.b)
        self.get_logger().info('operation %d / %d' % (request.a, request.b))
        if obj.b == 0:
            self.get_logger().warning('division by zero is not possible. try another!')
            response.sum = 0
        else:
            response.sum = obj.div()
        return response


def main(args=None):
    rclpy.init(args=args)
    calculator = CalculatorServiceServer()
    try:
        rclpy.spin(calculator)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    calculator.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
