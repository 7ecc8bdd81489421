import threading

import rclpy
from rclpy.node import Node
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from example_interfaces.srv import AddTwoInts


class Calculator(Node):
    def __init__(self):
        super().__init__('calculator')
        self.group = ReentrantCallbackGroup()
        self.lock = threading.Lock()
        self.served = 0
        for name, fn in (
            ('add', self.add), ('subtract', self.subtract),
            ('multiply', self.multiply), ('divide', self.divide),
        ):
            self.create_service(AddTwoInts, name, fn, callback_group=self.group)

    def done(self, text):
        with self.lock:
            self.served += 1
            n = self.served
        self.get_logger().info('[%d] %s' % (n, text))

    def add(self, req, res):
        res.sum = req.a + req.b
        self.done('%d + %d = %d' % (req.a, req.b, res.sum))
        return res

    def subtract(self, req, res):
        res.sum = req.a - req.b
        self.done('%d - %d = %d' % (req.a, req.b, res.sum))
        return res

    def multiply(self, req, res):
        res.sum = req.a * req.b
        self.done('%d * %d = %d' % (req.a, req.b, res.sum))
        return res

    def divide(self, req, res):
        if req.b == 0:
            self.get_logger().warning('refusing to divide %d by zero' % req.a)
            return res
        res.sum = req.a // req.b
        self.done('%d / %d = %d' % (req.a, req.b, res.sum))
        return res


def main():
    rclpy.init()
    node = Calculator()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
