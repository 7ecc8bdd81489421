import operator

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

OPS = {
    'add': operator.add,
    'subtract': operator.sub,
    'multiply': operator.mul,
    'divide': operator.floordiv,
}


class Demo(Node):
    def __init__(self):
        super().__init__('calculator_demo')
        for name, op in OPS.items():
            self.create_service(AddTwoInts, '~/' + name, self.make(op))

    def make(self, op):
        def callback(req, res):
            res.sum = op(req.a, req.b)
            return res
        return callback


def main():
    rclpy.init()
    node = Demo()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    for name in OPS:
        client = node.create_client(AddTwoInts, '~/' + name)
        client.wait_for_service(timeout_sec=3.0)
        future = client.call_async(AddTwoInts.Request(a=9, b=3))
        executor.spin_until_future_complete(future, timeout_sec=3.0)
        node.get_logger().info(f'{name}(9, 3) = {future.result().sum}')
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
