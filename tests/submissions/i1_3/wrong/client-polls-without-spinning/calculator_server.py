#!/usr/bin/env python3
"""Calculator server, two callback groups so that slow clients of one group do not hold up the other."""
from threading import Thread

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


def main():
    rclpy.init()

    # Create node for this example
    node = Node("calculator_server")

    # Create callback group that allows execution of callbacks in parallel without restrictions
    callback_group = ReentrantCallbackGroup()

    def add(request, response):
        response.sum = request.a + request.b
        return response

    def subtract(request, response):
        response.sum = request.a - request.b
        return response

    def multiply(request, response):
        response.sum = request.a * request.b
        return response

    def divide(request, response):
        if request.b == 0:
            node.get_logger().error(f"divide: {request.a} / 0: division by zero")
            response.sum = 0
            return response
        response.sum = request.a // request.b
        return response

    for callback in (add, subtract, multiply, divide):
        node.create_service(
            AddTwoInts, callback.__name__, callback, callback_group=callback_group
        )

    # Spin the node in background thread(s)
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)

    def spin():
        try:
            executor.spin()
        except ExternalShutdownException:
            pass

    executor_thread = Thread(target=spin, daemon=True, args=())
    executor_thread.start()

    try:
        executor_thread.join()
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()
    executor_thread.join(timeout=2.0)


if __name__ == "__main__":
    main()
