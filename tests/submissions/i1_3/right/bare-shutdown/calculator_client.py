import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


class Client(Node):
    def __init__(self):
        super().__init__('client')
        self.group = MutuallyExclusiveCallbackGroup()
        self.done = Future()
        self.timer = self.create_timer(0.1, self.work)

    def work(self):
        self.timer.cancel()
        for name in ('add', 'subtract', 'multiply', 'divide'):
            client = self.create_client(AddTwoInts, name, callback_group=self.group)
            client.wait_for_service()
            self.get_logger().info(f'{name}: {client.call(AddTwoInts.Request(a=6, b=3)).sum}')
        self.done.set_result(True)


rclpy.init()
node = Client()
executor = MultiThreadedExecutor(2)
executor.add_node(node)
executor.spin_until_future_complete(node.done)
executor.shutdown()
node.destroy_node()
rclpy.shutdown()
