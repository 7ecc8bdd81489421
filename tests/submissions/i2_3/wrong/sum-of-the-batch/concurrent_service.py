#!/usr/bin/env python3
import threading
import time
import numpy as np
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        group = ReentrantCallbackGroup()
        self.tick = 0
        self.batch = []
        self.open_calls = 0
        self.lock = threading.Lock()
        self.srv = self.create_service(
            AddTwoInts, 'slow_add', self.slow_add, callback_group=group)
        self.timer = self.create_timer(0.1, self.on_tick, callback_group=group)

    def slow_add(self, request, response):
        with self.lock:
            self.open_calls += 1
            self.batch += [request.a, request.b]
        time.sleep(3.0)
        with self.lock:
            response.sum = int(np.sum(np.array(self.batch, dtype=np.int64)))
            self.open_calls -= 1
            if self.open_calls == 0:
                self.batch.clear()
        return response

    def on_tick(self):
        self.tick += 1
        if self.tick % 10 == 0:
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
