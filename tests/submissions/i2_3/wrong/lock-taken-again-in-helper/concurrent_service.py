import threading
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        group = ReentrantCallbackGroup()
        self._lock = threading.Lock()
        self._served = 0
        self._ticks = 0
        self.create_service(AddTwoInts, 'slow_add', self._slow_add, callback_group=group)
        self.create_timer(0.1, self._tick, callback_group=group)

    def _count(self):
        with self._lock:
            self._served += 1
            return self._served

    def _slow_add(self, request, response):
        time.sleep(3.0)
        with self._lock:
            response.sum = request.a + request.b
            self.get_logger().info(f'call {self._count()} done')
        return response

    def _tick(self):
        self._ticks += 1
        if self._ticks % 10 == 0:
            self.get_logger().info(f'Tick {self._ticks}')


def main():
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
