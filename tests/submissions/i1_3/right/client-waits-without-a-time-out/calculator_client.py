import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import SingleThreadedExecutor

rclpy.init()
node = rclpy.create_node('calculator_client')
executor = SingleThreadedExecutor()
executor.add_node(node)
thread = threading.Thread(target=executor.spin, daemon=True)
thread.start()

for name in ('add', 'subtract', 'multiply', 'divide'):
    client = node.create_client(AddTwoInts, name)
    client.wait_for_service()
    answered = threading.Event()
    future = client.call_async(AddTwoInts.Request(a=12, b=4))
    future.add_done_callback(lambda _, answered=answered: answered.set())
    answered.wait()  # however long it takes
    node.get_logger().info(f'{name}: {future.result().sum}')

executor.shutdown()
thread.join()
rclpy.try_shutdown()
