import sys
import rclpy
from example_interfaces.srv import AddTwoInts

if len(sys.argv) != 4:
    print('usage: calculator_client.py add|subtract|multiply|divide A B')
    sys.exit(2)

rclpy.init()
node = rclpy.create_node('client')
client = node.create_client(AddTwoInts, sys.argv[1])
client.wait_for_service()
future = client.call_async(AddTwoInts.Request(a=int(sys.argv[2]), b=int(sys.argv[3])))
rclpy.spin_until_future_complete(node, future)
print(future.result().sum)
rclpy.shutdown()
