import sys

import rclpy
from example_interfaces.srv import AddTwoInts


def main():
    rclpy.init()
    node = rclpy.create_node('calculator_client')
    for name in ('add', 'subtract', 'multiply', 'divide'):
        client = node.create_client(AddTwoInts, name)
        if not client.service_is_ready():
            node.get_logger().error(f'{name} is not available')
            return 1
        future = client.call_async(AddTwoInts.Request(a=6, b=2))
        rclpy.spin_until_future_complete(node, future)
        node.get_logger().info(f'{name} = {future.result().sum}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
