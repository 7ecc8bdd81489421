import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.service_group = ReentrantCallbackGroup()
        self.timer_group = MutuallyExclusiveCallbackGroup()
        self.counter = 0
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.slow_add_callback, callback_group=self.service_group)
        self.timer = self.create_timer(0.1, self.timer_callback, callback_group=self.timer_group)

    def slow_add_callback(self, request, response):
        self.get_logger().info(f'Incoming request: {request.a} + {request.b}')
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def timer_callback(self):
        self.counter += 1
        self.get_logger().info(f'Timer tick {self.counter}')


def main(args=None):
    rclpy.init(args=args)
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=4)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
