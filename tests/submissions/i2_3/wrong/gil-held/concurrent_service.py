#!/usr/bin/env python3
import ctypes
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

libc = ctypes.PyDLL(None)  # the C library, for sleep()


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.tick = 0
        self.srv = self.create_service(
            AddTwoInts, 'slow_add', self.slow_add, callback_group=ReentrantCallbackGroup())
        self.timer = self.create_timer(
            0.1, self.on_tick, callback_group=ReentrantCallbackGroup())

    def slow_add(self, request, response):
        libc.sleep(3)
        response.sum = request.a + request.b
        return response

    def on_tick(self):
        self.tick += 1
        self.get_logger().info(f'Timer tick: {self.tick}')


def main():
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=8)
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
