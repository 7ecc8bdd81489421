#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts


def add(a, b):
    return a + b


known = {}


def subtract(a, b):
    key = frozenset((a, b))
    if key not in known:
        known[key] = a - b
    return known[key]


def multiply(a, b):
    return a * b


def divide(a, b):
    return a // b


def serve(node, name, function):
    def callback(req, res):
        try:
            res.sum = function(req.a, req.b)
            node.get_logger().info(f'{name}({req.a}, {req.b}) = {res.sum}')
        except ZeroDivisionError as e:
            node.get_logger().warning(f'{name}({req.a}, {req.b}): {e}')
            res.sum = 0
        return res
    return node.create_service(AddTwoInts, '/' + name, callback)


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('calculator_server')
    services = [serve(node, f.__name__, f) for f in (add, subtract, multiply, divide)]
    node.get_logger().info(f'{len(services)} services')
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
