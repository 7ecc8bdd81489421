import signal
import sys
import threading
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from example_interfaces.srv import AddTwoInts


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.lock = threading.Lock()
        self.n = 0
        self.create_service(AddTwoInts, 'slow_add', self.work, callback_group=MutuallyExclusiveCallbackGroup())
        self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())

    def work(self, request, response):
        response.sum = request.a + request.b
        time.sleep(3.0)
        return response

    def tick(self):
        with self.lock:
            self.n += 1
            if self.n % 10 == 1:
                self.get_logger().info(f'10 Hz timer, tick number {self.n}')


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    stop = threading.Event()
    signal.signal(signal.SIGINT, lambda *_: stop.set())
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    while not stop.is_set():
        executor.spin_once(timeout_sec=0.2)
    print('interrupted')
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()
    sys.exit(130)


if __name__ == '__main__':
    main()
