#!/usr/bin/env python3
import time
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor, ExternalShutdownException
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
        pass
        self.get_logger().info('Concurrent service ready')

    def timer_callback(self):
        self.tick += 1
        self.say(f'Tick {self.tick}')

    def say(self, text):
        self.get_logger().info(text)

    def slow_callback(self, req, resp):
        for s in range(30):
            time.sleep(0.1)
            self.say(f'working, step {s} of 30')
        resp.sum = req.a + req.b
        return resp

def main():
    rclpy.init()
    node = ConcurrentService()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()

if __name__ == '__main__':
    main()
