import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service', enable_rosout=False, start_parameter_services=False)
        self.tick = 0
        group = ReentrantCallbackGroup()
        self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=group)
        self.create_timer(0.1, self.on_timer, callback_group=group)

    def slow_add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

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
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
