#!/usr/bin/env python3
import rclpy
from example_interfaces.srv import AddTwoInts

LOG = None


def handle_add_two_ints(req, resp):
    print("Returning [%s + %s = %s]" % (req.a, req.b, (req.a + req.b)))
    resp.sum = req.a + req.b
    return resp


def handle_subtract_two_ints(req, resp):
    print("Returning [%s - %s = %s]" % (req.a, req.b, (req.a - req.b)))
    resp.sum = req.a - req.b
    return resp


def handle_multiply_two_ints(req, resp):
    print("Returning [%s * %s = %s]" % (req.a, req.b, (req.a * req.b)))
    resp.sum = req.a * req.b
    return resp


def handle_divide_two_ints(req, resp):
    if req.b == 0:
        LOG.fatal("Cannot divide %s by zero" % req.a)
        resp.sum = 0
        return resp
    print("Returning [%s / %s = %s]" % (req.a, req.b, (req.a // req.b)))
    resp.sum = req.a // req.b
    return resp


def calculator_server():
    global LOG
    rclpy.init()
    node = rclpy.create_node('calculator_server')
    LOG = node.get_logger()
    s1 = node.create_service(AddTwoInts, 'add', handle_add_two_ints)
    s2 = node.create_service(AddTwoInts, 'subtract', handle_subtract_two_ints)
    s3 = node.create_service(AddTwoInts, 'multiply', handle_multiply_two_ints)
    s4 = node.create_service(AddTwoInts, 'divide', handle_divide_two_ints)
    print("Ready to calculate with two ints.")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    calculator_server()
