import time

import rclpy
from example_interfaces.srv import AddTwoInts

NAMES = ["/add", "/subtract", "/multiply", "/divide"]

rclpy.init()
node = rclpy.create_node("asker")
while not set(NAMES) <= {name for name, _ in node.get_service_names_and_types()}:
    time.sleep(0.2)
for name in NAMES:
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    future = client.call_async(AddTwoInts.Request(a=8, b=4))
    rclpy.spin_until_future_complete(node, future)
    print(name, future.result().sum)
node.destroy_node()
rclpy.shutdown()
