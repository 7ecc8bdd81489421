import rclpy
from example_interfaces.srv import AddTwoInts


def main():
    rclpy.init()
    node = rclpy.create_node('calculator_client')
    for name in ('add', 'subtract', 'multiply', 'divide'):
        client = node.create_client(AddTwoInts, name)
        client.wait_for_service()
        future = client.call_async(AddTwoInts.Request(a=24, b=-6))
        rclpy.spin_until_future_complete(node, future)
        print(f'{name}(24, -6) = {future.result().sum}')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
