import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class Client(Node):
    def __init__(self):
        super().__init__('client')
        self.cli = self.create_client(AddTwoInts, 'add')
        self.cli.wait_for_service()

    def call(self, a, b):
        future = self.cli.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future)
        return future.result().sum


rclpy.init()
client = Client()
print('add', client.call(10, 5))
print('subtract', client.call(10, -5))
print('multiply', client.call(25, 25))
print('divide', client.call(1, 1))
rclpy.shutdown()
