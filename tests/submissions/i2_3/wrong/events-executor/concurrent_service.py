#!/usr/bin/env python3
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class ConcurrentServiceNode(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.service_group = ReentrantCallbackGroup()
        self.timer_group = ReentrantCallbackGroup()
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.slow_callback, callback_group=self.service_group)
        self.timer = self.create_timer(0.1, self.timer_callback, callback_group=self.timer_group)
        self.tick = 0
        self.get_logger().info('Concurrent service ready')

    def slow_callback(self, req, resp):
        self.get_logger().info(f'Service called: {req.a} + {req.b}')
        time.sleep(3.0)
        resp.sum = req.a + req.b
        self.get_logger().info(f'Service complete: {resp.sum}')
        return resp

    def timer_callback(self):
        self.tick += 1
        if self.tick % 10 == 0:
            self.get_logger().info(f'Timer tick: {self.tick}')


def main():
    rclpy.init()
    node = ConcurrentServiceNode()
    executor = EventsExecutor()
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
