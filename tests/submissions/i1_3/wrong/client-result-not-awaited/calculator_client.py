import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node('client')
for name in ('add', 'subtract', 'multiply', 'divide'):
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    future = client.call_async(AddTwoInts.Request(a=8, b=2))
    print(name, future.result().sum)
rclpy.shutdown()
