import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


def main():
    rclpy.init()
    node = Node('calculator_client')
    for name in ['add', 'subtract', 'multiply', 'divide']:
        client = node.create_client(AddTwoInts, name)
        while not client.wait_for_service(timeout_sec=1.0):
            node.get_logger().info('waiting for ' + name)
        future = client.call_async(AddTwoInts.Request(a=12, b=4))
        rclpy.spin_until_future_complete(node, future)
        node.get_logger().info(f'12 {name} 4 = {future.result().sum}')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
