#!/usr/bin/env python3
import random

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


def main():
    rclpy.init()
    node = Node('numpy_client')
    clients = {n: node.create_client(AddTwoInts, n) for n in ['multiply', 'divide', 'add', 'subtract']}
    while not all(c.service_is_ready() for c in clients.values()):
        rclpy.spin_once(node, timeout_sec=0.1)

    for _ in range(3):
        b = random.randint(1, 50)
        q = random.randint(-50, 50)
        for name, a in (('multiply', q), ('divide', q * b), ('add', q), ('subtract', q)):
            future = clients[name].call_async(AddTwoInts.Request(a=a, b=b))
            rclpy.spin_until_future_complete(node, future)
            node.get_logger().info(f'{name:>8} {a:5d} {b:3d} -> {future.result().sum:6d}')

    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
