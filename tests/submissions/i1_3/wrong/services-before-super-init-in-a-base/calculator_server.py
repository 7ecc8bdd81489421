#!/usr/bin/env python3
# 계산기 서비스 노드 (덧셈, 뺄셈, 곱셈, 나눗셈)
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class ArithmeticBase(Node):

    def __init__(self, node_name):
        # 서비스 설정
        self.srv_list = []
        self.total_count = 0
        self.setup_services()

        super().__init__(node_name)
        self.get_logger().info(f'[READY] node={node_name}')

    def setup_services(self):
        raise NotImplementedError


class CalculatorServer(ArithmeticBase):

    def __init__(self):
        super().__init__('calculator_server')

    def setup_services(self):
        self.srv_list.append(self.create_service(AddTwoInts, 'add', self.add_callback))
        self.srv_list.append(self.create_service(AddTwoInts, 'subtract', self.subtract_callback))
        self.srv_list.append(self.create_service(AddTwoInts, 'multiply', self.multiply_callback))
        self.srv_list.append(self.create_service(AddTwoInts, 'divide', self.divide_callback))

    # 덧셈
    def add_callback(self, request, response):
        response.sum = request.a + request.b
        return self.done('+', request, response)

    # 뺄셈
    def subtract_callback(self, request, response):
        response.sum = request.a - request.b
        return self.done('-', request, response)

    # 곱셈
    def multiply_callback(self, request, response):
        response.sum = request.a * request.b
        return self.done('x', request, response)

    # 나눗셈
    def divide_callback(self, request, response):
        if request.b == 0:
            self.get_logger().error('0으로 나눌 수 없습니다 (division by zero)')
            response.sum = 0
            return response
        response.sum = request.a // request.b
        return self.done('/', request, response)

    def done(self, op, request, response):
        self.total_count += 1
        self.get_logger().info(f'({self.total_count}) {request.a} {op} {request.b} = {response.sum}')
        return response


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info('Keyboard Interrupt (SIGINT)')
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
