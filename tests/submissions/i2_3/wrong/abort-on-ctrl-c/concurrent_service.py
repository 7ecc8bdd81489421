import os
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class SlowAdder(Node):
    def __init__(self):
        super().__init__('slow_adder')
        self.ticks = 0
        self.calls = ReentrantCallbackGroup()
        self.ticking = MutuallyExclusiveCallbackGroup()
        self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=self.calls)
        self.create_timer(0.1, self.tick, callback_group=self.ticking)

    def slow_add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f'{self.ticks} ticks')


def main():
    rclpy.init()
    node = SlowAdder()
    executor = MultiThreadedExecutor(6)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        # the threads that sleep in a call would keep the program alive
        os.abort()


if __name__ == '__main__':
    main()
