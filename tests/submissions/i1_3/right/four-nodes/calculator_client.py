import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class OneCall(Node):
    def __init__(self, service):
        super().__init__(service + '_client')
        self.service = service
        self.client = self.create_client(AddTwoInts, service)

    def run(self):
        self.client.wait_for_service()
        future = self.client.call_async(AddTwoInts.Request(a=100, b=10))
        rclpy.spin_until_future_complete(self, future)
        print(self.service, '->', future.result().sum)


rclpy.init()
for s in ['add', 'subtract', 'multiply', 'divide']:
    OneCall(s).run()
rclpy.shutdown()
