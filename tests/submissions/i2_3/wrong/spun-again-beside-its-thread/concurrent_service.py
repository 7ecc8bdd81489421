import threading
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class SlowAdder(Node):
    def __init__(self):
        super().__init__('slow_adder')
        group = ReentrantCallbackGroup()
        self.ticks = 0
        self.create_service(AddTwoInts, '/slow_add', self.add, callback_group=group)
        self.create_timer(0.1, self.tick, callback_group=group)

    def add(self, request, response):
        time.sleep(3)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f'tick {self.ticks}')


def run_executor(executor):
    try:
        executor.spin()
    except ExternalShutdownException:
        pass


def main():
    rclpy.init()
    node = SlowAdder()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    threading.Thread(target=run_executor, args=(executor,), daemon=True).start()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


main()
