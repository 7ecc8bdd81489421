#!/usr/bin/env python3
import time
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from example_interfaces.srv import AddTwoInts


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.tick = 0
        self.busy = 0
        self.t0 = time.time()
        self.group_a = ReentrantCallbackGroup()
        self.group_b = ReentrantCallbackGroup()
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.slow_callback, callback_group=self.group_a)
        self.timer = self.create_timer(0.1, self.timer_callback, callback_group=self.group_b)
        for i in range(30):
            self.get_logger().info(f'loading model, part {i + 1} of 30')
            time.sleep(0.1)
        self.get_logger().info('Concurrent service ready')

    def timer_callback(self):
        self.tick += 1
        if self.tick % 10 == 0:
            self.get_logger().info(f'Timer tick: {self.tick}')

    def slow_callback(self, req, resp):
        self.get_logger().info(f'Service called: {req.a} + {req.b}')
        self.busy += 1
        time.sleep(3.0)
        self.busy -= 1
        resp.sum = req.a + req.b
        self.get_logger().info(f'Service complete: {resp.sum}')
        return resp

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
        rclpy.try_shutdown()

if __name__ == '__main__':
    main()
