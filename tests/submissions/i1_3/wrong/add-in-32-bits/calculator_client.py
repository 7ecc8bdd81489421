#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

def main():
    rclpy.init()
    node = Node('calculator_client')
    for name, a, b in (('add', 10, 5), ('subtract', 10, 5), ('multiply', 10, 5), ('divide', 10, 5)):
        client = node.create_client(AddTwoInts, name)
        while not client.wait_for_service(timeout_sec=1.0):
            node.get_logger().info('waiting for ' + name)
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(node, future)
        print(f'{name}({a}, {b}) = {future.result().sum}')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
