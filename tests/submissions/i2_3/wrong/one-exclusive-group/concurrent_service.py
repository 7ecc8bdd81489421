import threading
import time
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import ReentrantCallbackGroup, MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from example_interfaces.srv import AddTwoInts


class SlowAdder(Node):
    """Adds slowly, ticks fast."""

    def __init__(self):
        super().__init__('slow_adder')
        cbg = MutuallyExclusiveCallbackGroup()
        self.counter = 0
        self.create_timer(0.1, self.on_timer, callback_group=cbg)
        self.create_service(AddTwoInts, '/slow_add', self.on_request, callback_group=cbg)

    def on_timer(self):
        self.counter += 1
        self.get_logger().info('tick %d' % self.counter)

    def on_request(self, request, response):
        time.sleep(3)
        response.sum = request.a + request.b
        return response


def main(args=None):
    rclpy.init(args=args)
    node = SlowAdder()
    ex = MultiThreadedExecutor(8)
    ex.add_node(node)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
