import argparse
import sys
import rclpy
from arithmetic import OPERATIONS
from example_interfaces.srv import AddTwoInts

parser = argparse.ArgumentParser()
parser.add_argument('a', type=int, nargs='?', default=15)
parser.add_argument('b', type=int, nargs='?', default=3)
options = parser.parse_args()

if sys.stdin.isatty():
    input('Press Enter to start')

rclpy.init()
node = rclpy.create_node('client')
for name in OPERATIONS:
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    future = client.call_async(AddTwoInts.Request(a=options.a, b=options.b))
    rclpy.spin_until_future_complete(node, future, timeout_sec=10.0)
    print(name, future.result())
node.destroy_node()
rclpy.shutdown()
