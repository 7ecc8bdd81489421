#!/usr/bin/env python3
# Ctrl+C should just kill it, as it kills a C program.
import signal
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        g = ReentrantCallbackGroup()
        self.tick = 0
        self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=g)
        self.create_timer(0.1, self.on_tick, callback_group=g)

    def slow_add(self, request, response):
        time.sleep(3)
        response.sum = request.a + request.b
        return response

    def on_tick(self):
        self.tick += 1
        if self.tick % 10 == 0:
            self.get_logger().info('tick %d' % self.tick)


rclpy.init()
signal.signal(signal.SIGINT, signal.SIG_DFL)  # must come after init
executor = MultiThreadedExecutor(num_threads=6)
node = ConcurrentService()
executor.add_node(node)
executor.spin()
