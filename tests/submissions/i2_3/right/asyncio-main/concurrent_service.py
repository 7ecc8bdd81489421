#!/usr/bin/env python3
"""asyncio owns the process, the executor runs in its thread pool."""
import asyncio
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        group = ReentrantCallbackGroup()
        self.create_service(AddTwoInts, 'slow_add', self.add, callback_group=group)
        self.create_timer(0.1, self.tick, callback_group=group)
        self.count = 0

    def add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.count += 1
        if self.count % 10 == 0:
            self.get_logger().info(f'Timer tick: {self.count}')


async def main():
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    await asyncio.get_running_loop().run_in_executor(None, executor.spin)


if __name__ == '__main__':
    try:
        asyncio.run(main())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
