import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class RechenClient(Node):
    def __init__(self):
        super().__init__('rechen_client')

    def frage(self, dienst, a, b):
        client = self.create_client(AddTwoInts, dienst)
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('Dienst /%s noch nicht da, warte...' % dienst)
        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info('/%s: %d, %d -> %d' % (dienst, a, b, future.result().sum))
        self.destroy_client(client)


def main():
    rclpy.init()
    client = RechenClient()
    for dienst in ['add', 'subtract', 'multiply', 'divide']:
        client.frage(dienst, 56, -8)
    client.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
