import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.tick = 0
        group = ReentrantCallbackGroup()
        self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=group)
        self.create_timer(0.1, self.on_timer, callback_group=group)
        self.client = self.create_client(AddTwoInts, 'slow_add', callback_group=group)

    def slow_add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def self_test(self):
        self.client.wait_for_service()
        assert self.client.call(AddTwoInts.Request(a=2, b=2)).sum == 4
        self.get_logger().info('self-test passed')

    def on_timer(self):
        self.tick += 1
        if self.tick % 10 == 0:
            self.get_logger().info(f'Timer tick: {self.tick}')


def main():
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    try:
        node.self_test()
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
