import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node('client')
for name in ('add', 'subtract', 'multiply', 'divide'):
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    print(name, client.call(AddTwoInts.Request(a=8, b=2)).sum)
rclpy.shutdown()
