from functools import partial

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException


def calculate(node, sign, request, response):
    a, b = request.a, request.b
    if sign == '+':
        response.sum = a + b
    elif sign == '-':
        response.sum = a - b
    elif sign == '*':
        response.sum = a * b
    elif b == 0:
        node.get_logger().info('cannot divide by zero')
        return response
    else:
        response.sum = int(a / b)
    node.get_logger().info(f'{a} {sign} {b} = {response.sum}')
    return response


def main():
    rclpy.init()
    node = rclpy.create_node('calculator', namespace='tools')
    services = [
        node.create_service(AddTwoInts, '/add', partial(calculate, node, '+')),
        node.create_service(AddTwoInts, '/subtract', partial(calculate, node, '-')),
        node.create_service(AddTwoInts, '/multiply', partial(calculate, node, '*')),
        node.create_service(AddTwoInts, '/divide', partial(calculate, node, '/')),
    ]
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.05)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    for service in services:
        node.destroy_service(service)
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
