import atexit
import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.tick = 0
        self.stop = threading.Event()
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.slow_add,
                                       callback_group=ReentrantCallbackGroup())
        self.timer = self.create_timer(0.1, self.on_timer, callback_group=ReentrantCallbackGroup())

    def slow_add(self, request, response):
        self.get_logger().info(f'{request.a} + {request.b}: working')
        self.stop.wait(3.0)
        response.sum = request.a + request.b
        return response

    def on_timer(self):
        self.tick += 1
        if self.tick % 10 == 0:
            self.get_logger().info(f'Timer tick: {self.tick}')


def main():
    rclpy.init()
    atexit.register(rclpy.shutdown)
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=8)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.stop.set()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
