import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node('calc_client')
clients = {n: node.create_client(AddTwoInts, '/' + n) for n in ('add', 'subtract', 'multiply', 'divide')}
for c in clients.values():
    c.wait_for_service()
# ask all at once, then wait for all
futures = {n: c.call_async(AddTwoInts.Request(a=-20, b=5)) for n, c in clients.items()}
for n, f in futures.items():
    rclpy.spin_until_future_complete(node, f)
    print(n, f.result().sum)
rclpy.shutdown()
