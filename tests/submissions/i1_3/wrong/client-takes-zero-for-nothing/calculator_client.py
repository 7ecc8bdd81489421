"""Asks again until there is a result."""

import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node("calculator_client")
for name in ("add", "subtract", "multiply", "divide"):
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    result = None
    while not result:
        future = client.call_async(AddTwoInts.Request(a=7, b=7))
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        if future.done():
            result = future.result().sum
    node.get_logger().info(f"{name}: {result}")
node.destroy_node()
rclpy.shutdown()
