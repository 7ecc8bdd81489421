import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node('client')
results = {}
for name in ('add', 'subtract', 'multiply', 'divide'):
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    future = client.call_async(AddTwoInts.Request(a=8, b=2))
    rclpy.spin_until_future_complete(node, future)
    results[name] = future.result().sum
print(result)
rclpy.shutdown()
