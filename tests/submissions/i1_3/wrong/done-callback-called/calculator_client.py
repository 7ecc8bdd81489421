import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_lab_client')
        self.services_to_call = ['add', 'subtract', 'multiply', 'divide']
        self.replies = {}

    def callback_reply(self, future, name):
        self.replies[name] = future.result().sum
        self.get_logger().info('%s -> %d' % (name, self.replies[name]))

    def call_all(self, a, b):
        for name in self.services_to_call:
            client = self.create_client(AddTwoInts, name)
            while not client.wait_for_service(1.0):
                self.get_logger().warn('Waiting for server %s...' % name)
            request = AddTwoInts.Request()
            request.a = a
            request.b = b
            future = client.call_async(request)
            future.add_done_callback(self.callback_reply(future, name))

    def finished(self):
        return len(self.replies) == len(self.services_to_call)


def main():
    rclpy.init(args=None)
    client = CalculatorClient()
    client.call_all(24, 6)
    while rclpy.ok() and not client.finished():
        rclpy.spin_once(client, timeout_sec=0.2)
    client.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
