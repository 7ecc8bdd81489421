import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


def main():
    rclpy.init()
    node = Node('calc_client')
    clients = {}
    for op in ('add', 'subtract', 'multiply', 'divide'):
        clients[op] = node.create_client(AddTwoInts, op)
    for op, client in clients.items():
        future = client.call_async(AddTwoInts.Request(a=12, b=4))
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        if future.done():
            node.get_logger().info(f'{op}: {future.result().sum}')
        else:
            node.get_logger().warn(f'{op}: no answer')
    node.destroy_node()
    rclpy.shutdown()


main()
