#!/usr/bin/env python3
import sys

import rclpy
from example_interfaces.srv import AddTwoInts


def calc_client(node, name, x, y):
    proxy = node.create_client(AddTwoInts, name)
    proxy.wait_for_service()
    req = AddTwoInts.Request()
    req.a = x
    req.b = y
    fut = proxy.call_async(req)
    rclpy.spin_until_future_complete(node, fut)
    return fut.result()


if __name__ == "__main__":
    if len(sys.argv) == 3:
        x = int(sys.argv[1])
        y = int(sys.argv[2])
    else:
        x, y = 20, 5
    rclpy.init()
    node = rclpy.create_node("calc_ints_client")
    print("Requesting %s and %s" % (x, y))
    print("add      ", calc_client(node, "add", x, y))
    print("subtract ", calc_client(node, "subtract", x, y))
    print("multiply ", calc_client(node, "multiply", x, y))
    print("divide   ", calc_client(node, "divide", x, y))
    node.destroy_node()
    rclpy.shutdown()
