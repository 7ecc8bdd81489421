import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.ticks = 0
        # each gets its own exclusive group
        self.service_group = self.timer_group = MutuallyExclusiveCallbackGroup()
        self.service = self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=self.service_group)
        self.timer = self.create_timer(0.1, self.tick, callback_group=self.timer_group)

    def tick(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f'tick {self.ticks}')

    def slow_add(self, request, response):
        self.get_logger().info(f'adding {request.a} and {request.b}')
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(ConcurrentService())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
