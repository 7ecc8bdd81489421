#!/usr/bin/env python3
import threading
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
        self.condition = threading.Condition()
        self.srv = self.create_service(
            AddTwoInts, 'slow_add', self.slow_add, callback_group=group)
        self.timer = self.create_timer(0.1, self.on_tick, callback_group=group)

    def slow_add(self, request, response):
        # wait() lets the timer have the lock meanwhile
        with self.condition:
            self.condition.wait(timeout=3.0)
        response.sum = request.a + request.b
        return response

    def on_tick(self):
        with self.condition:
            self.tick += 1
            number = self.tick
            self.condition.notify_all()
        if number % 10 == 0:
            self.get_logger().info(f'Timer tick: {number}')


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
