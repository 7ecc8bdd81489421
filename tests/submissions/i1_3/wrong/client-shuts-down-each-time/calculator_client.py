#!/usr/bin/env python3
import sys

import rclpy
from example_interfaces.srv import AddTwoInts


def two_ints_client(service, x, y):
    node = rclpy.create_node(service + '_two_ints_client')
    cli = node.create_client(AddTwoInts, service)
    while not cli.wait_for_service(timeout_sec=1.0):
        node.get_logger().info('service not available, waiting again...')

    req = AddTwoInts.Request()
    req.a = x
    req.b = y
    future = cli.call_async(req)
    while rclpy.ok():
        rclpy.spin_once(node)
        if future.done():
            break

    node.destroy_node()
    rclpy.shutdown()
    return future.result().sum


def usage():
    return "%s [x y]" % sys.argv[0]


if __name__ == "__main__":
    if len(sys.argv) == 3:
        x = int(sys.argv[1])
        y = int(sys.argv[2])
    elif len(sys.argv) == 1:
        x, y = 14, 7
    else:
        print(usage())
        sys.exit(1)
    rclpy.init()
    print("%s + %s = %s" % (x, y, two_ints_client('add', x, y)))
    print("%s - %s = %s" % (x, y, two_ints_client('subtract', x, y)))
    print("%s * %s = %s" % (x, y, two_ints_client('multiply', x, y)))
    print("%s / %s = %s" % (x, y, two_ints_client('divide', x, y)))
