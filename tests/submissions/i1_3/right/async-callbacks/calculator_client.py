import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import SingleThreadedExecutor


async def ask_all(node):
    for name in ('add', 'subtract', 'multiply', 'divide'):
        client = node.create_client(AddTwoInts, name)
        client.wait_for_service()
        answer = await client.call_async(AddTwoInts.Request(a=9, b=3))
        node.get_logger().info(f'{name}: {answer.sum}')


def main():
    rclpy.init()
    node = rclpy.create_node('async_client')
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    task = executor.create_task(ask_all, node)
    executor.spin_until_future_complete(task)
    rclpy.shutdown()


if __name__ == '__main__':
    main()
