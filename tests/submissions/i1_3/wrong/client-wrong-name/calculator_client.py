import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node('client')
for name in ('add', 'subtract', 'multiply', 'div'):
    client = node.create_client(AddTwoInts, name)
    while not client.wait_for_service(timeout_sec=1.0):
        node.get_logger().info(f'{name} not available, waiting again...')
    future = client.call_async(AddTwoInts.Request(a=8, b=2))
    rclpy.spin_until_future_complete(node, future)
    print(name, future.result().sum)
rclpy.shutdown()
