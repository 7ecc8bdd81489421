#!/usr/bin/env python3
# ported from beginner_tutorials/scripts/calc_ints_server.py (noetic)
import rclpy

from example_interfaces.srv import AddTwoInts

ADD = "add"
SUB = "subtract"
MUL = "multiply"
DIV = "divide"

node = None


def handle_calc(req, response, operation):
    if operation == ADD:
        response.sum = req.a + req.b
        node.get_logger().info(f"Returning [{req.a} + {req.b} = {response.sum}]")
        return response
    if operation == SUB:
        response.difference = req.a - req.b
        node.get_logger().info(f"Returning [{req.a} - {req.b} = {response.difference}]")
        return response
    if operation == MUL:
        response.product = req.a * req.b
        node.get_logger().info(f"Returning [{req.a} * {req.b} = {response.product}]")
        return response
    if operation == DIV:
        if req.b == 0:
            node.get_logger().error(f"Error: [{req.a} / 0] division by zero")
            response.quotient = 0
            return response
        response.quotient = req.a // req.b
        node.get_logger().info(f"Returning [{req.a} / {req.b} = {response.quotient}]")
        return response


def calc_server():
    global node
    rclpy.init()
    node = rclpy.create_node("calc_ints_server")
    node.create_service(AddTwoInts, ADD, lambda req, res: handle_calc(req, res, ADD))
    node.create_service(AddTwoInts, SUB, lambda req, res: handle_calc(req, res, SUB))
    node.create_service(AddTwoInts, MUL, lambda req, res: handle_calc(req, res, MUL))
    node.create_service(AddTwoInts, DIV, lambda req, res: handle_calc(req, res, DIV))
    node.get_logger().info("Ready to calc ints.")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    calc_server()
