"""Ask all calculator tools in parallel."""

import concurrent.futures

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

# Shared thread pool for ROS (so that spinning does not block the main thread)
_ros_executor = concurrent.futures.ThreadPoolExecutor(max_workers=1)


def _spin(node):
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass


def main():
    rclpy.init()
    node = Node('calculator_client')

    tools = {}
    for tool_name in ('add', 'subtract', 'multiply', 'divide'):
        tools[tool_name] = node.create_client(AddTwoInts, tool_name)
    for tool in tools.values():
        tool.wait_for_service()

    _ros_executor.submit(_spin, node)

    try:
        futures = {
            tool.call_async(AddTwoInts.Request(a=144, b=12)): tool_name
            for tool_name, tool in tools.items()
        }
        for future in concurrent.futures.as_completed(futures, timeout=10.0):
            node.get_logger().info('%s -> %d' % (futures[future], future.result().sum))
    finally:
        rclpy.shutdown()
        _ros_executor.shutdown(wait=True)


if __name__ == '__main__':
    main()
