import rclpy
from std_srvs.srv import Trigger

rclpy.init()
node = rclpy.create_node('client')
for name in ('add', 'subtract', 'multiply', 'divide'):
    client = node.create_client(Trigger, name)
    client.wait_for_service()
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future)
    print(name, future.result())
rclpy.shutdown()
