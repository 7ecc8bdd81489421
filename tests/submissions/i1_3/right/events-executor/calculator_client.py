import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.experimental import EventsExecutor


def main():
    rclpy.init()
    node = rclpy.create_node('calculator_client')
    executor = EventsExecutor()
    executor.add_node(node)
    for name in ('add', 'subtract', 'multiply', 'divide'):
        client = node.create_client(AddTwoInts, name)
        client.wait_for_service()
        future = client.call_async(AddTwoInts.Request(a=12, b=4))
        executor.spin_until_future_complete(future)
        node.get_logger().info(f'{name}(12, 4) = {future.result().sum}')
    rclpy.shutdown()


if __name__ == '__main__':
    main()
