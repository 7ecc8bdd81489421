import rclpy
from example_interfaces.srv import AddTwoInts


def ask(node, name, a, b):
    client = node.create_client(AddTwoInts, name)
    for _ in range(10):
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(node, future, timeout_sec=0.5)
        if future.done():
            return future.result().sum
        client.remove_pending_request(future)
        node.get_logger().warning(f'no answer from {name}, asking again')
    raise RuntimeError(f'{name} does not answer')


def main():
    rclpy.init()
    node = rclpy.create_node('persistent_client')
    for name in ('add', 'subtract', 'multiply', 'divide'):
        node.get_logger().info(f"{name}: {ask(node, name, 21, 7)}")
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
