import threading

from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node


class Adder(Node):
    """Adds slowly, beside a timer."""

    def __init__(self):
        super().__init__('concurrent_service')
        group = ReentrantCallbackGroup()
        self.ticks = 0
        self.work_done = threading.Event()
        self.create_service(AddTwoInts, 'slow_add', self.add, callback_group=group)
        self.create_timer(0.1, self.tick, callback_group=group)

    def tick(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f'tick {self.ticks}')

    def add(self, request, response):
        # the work takes a while
        self.work_done.wait()
        response.sum = request.a + request.b
        return response
