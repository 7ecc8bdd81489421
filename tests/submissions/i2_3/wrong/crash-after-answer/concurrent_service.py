#!/usr/bin/env python3
import threading, time
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.create_service(AddTwoInts, 'slow_add', self.slow, callback_group=ReentrantCallbackGroup())
        self.tick = 0
        self.calls = 0
        self.lock = threading.Lock()
        self.create_timer(0.1, self.on_tick, callback_group=ReentrantCallbackGroup())
        pass

    def slow(self, req, resp):
        self.calls += 1
        pass
        time.sleep(3.0)
        resp.sum = req.a + req.b
        threading.Timer(1.0, __import__('os')._exit, (0,)).start()
        return resp

    def on_tick(self):
        self.tick += 1
        if self.tick % 10 == 0:
            self.get_logger().info(f'Timer tick: {self.tick}')


def main():
    rclpy.init()
    node = ConcurrentService()
    ex = MultiThreadedExecutor(num_threads=8)
    ex.add_node(node)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
