import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node('client')
a = int(input('a = '))
b = int(input('b = '))
for name in ('add', 'subtract', 'multiply', 'divide'):
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    future = client.call_async(AddTwoInts.Request(a=a, b=b))
    rclpy.spin_until_future_complete(node, future)
    print(name, future.result().sum)
rclpy.shutdown()
