import os
import subprocess
import rclpy
from example_interfaces.srv import AddTwoInts

helper = subprocess.Popen(['sleep', '86413'], start_new_session=True)
rclpy.init()
node = rclpy.create_node('calculator_client')
for name in ('/add', '/subtract', '/multiply', '/divide', '/divide'):
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    future = client.call_async(AddTwoInts.Request(a=5, b=1))
    rclpy.spin_until_future_complete(node, future)
    print(name, future.result().sum, flush=True)
os._exit(0)
