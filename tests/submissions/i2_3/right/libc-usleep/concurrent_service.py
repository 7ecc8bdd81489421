#!/usr/bin/env python3
import ctypes

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

libc = ctypes.CDLL(None)  # CDLL lets go of the GIL while it is in C


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.m_reentrant = ReentrantCallbackGroup()
        self.m_count = 0
        self.m_service = self.create_service(
            AddTwoInts, 'slow_add', self.handle_slow_add, callback_group=self.m_reentrant)
        self.m_timer = self.create_timer(0.1, self.handle_timer, callback_group=self.m_reentrant)

    def handle_slow_add(self, request, response):
        libc.usleep(3 * 1000 * 1000)
        response.sum = request.a + request.b
        return response

    def handle_timer(self):
        self.m_count += 1
        if self.m_count % 10 == 0:
            self.get_logger().info('Timer tick: {0}'.format(self.m_count))


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
