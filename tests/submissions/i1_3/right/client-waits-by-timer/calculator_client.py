import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class CalculatorClient(Node):
    def __init__(self):
        super().__init__('calculator_client')
        self.operations = {n: self.create_client(AddTwoInts, n) for n in ('add', 'subtract', 'multiply', 'divide')}
        self.waiting = self.create_timer(0.3, self.look)
        self.left = len(self.operations)

    def look(self):
        if not all(client.service_is_ready() for client in self.operations.values()):
            self.get_logger().info('not all services are there yet')
            return
        self.waiting.cancel()
        for name, client in self.operations.items():
            future = client.call_async(AddTwoInts.Request(a=14, b=7))
            future.add_done_callback(lambda done, name=name: self.show(name, done.result()))

    def show(self, name, response):
        self.get_logger().info(f'{name}: {response.sum}')
        self.left -= 1


def main():
    rclpy.init()
    node = CalculatorClient()
    while rclpy.ok() and node.left:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
