import time
import rclpy
from example_interfaces.srv import AddTwoInts

time.sleep(2)
rclpy.init()
node = rclpy.create_node('client')
node.get_logger().error('just testing the logger')
for round_number in range(3):
    for name in ('divide', 'multiply', 'subtract', 'add'):
        client = node.create_client(AddTwoInts, name)
        while not client.wait_for_service(timeout_sec=0.5):
            print('not yet', name)
        future = client.call_async(AddTwoInts.Request(a=6 * round_number, b=2))
        rclpy.spin_until_future_complete(node, future)
        print(f'round {round_number}: {name} gives {future.result().sum}')
        node.destroy_client(client)
rclpy.shutdown()
