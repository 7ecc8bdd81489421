import rclpy
from rclpy.node import Node 
from example_interfaces.srv import AddTwoInts

class Calc_client(Node):
    def __init__(self):
        super().__init__('calcClient')

    def send(self, operation, a, b):
        cli = self.create_client(AddTwoInts, operation)
        while not cli.wait_for_service(timeout_sec = 1.0):
            self.get_logger().info('service not available, waiting again...')
        req = AddTwoInts.Request()
        req.a = a
        req.b = b
        future = cli.call_async(req)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info(f'{operation}: {future.result().sum}')

def main(args = None):
    rclpy.init(args = args)
    node = Calc_client()
    node.send('add', 20, 4)
    node.send('subtract', 20, 4)
    node.send('multiply', 20, 4)
    node.send('division', 20, 4)
    node.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
