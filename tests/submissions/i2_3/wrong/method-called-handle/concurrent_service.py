import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.cb_group = ReentrantCallbackGroup()
        self.counter = 0
        self.service = self.create_service(
            AddTwoInts, 'slow_add', self.handle, callback_group=self.cb_group)
        self.timer = self.create_timer(0.1, self.on_timer, callback_group=self.cb_group)

    def handle(self, request, response):
        time.sleep(3)
        response.sum = request.a + request.b
        return response

    def on_timer(self):
        self.counter += 1
        self.get_logger().info('Timer tick %d' % self.counter)


def main():
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
