import time

from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from running import run_threaded


class ConcurrentService(Node):
    def __init__(self):
        super().__init__("concurrent_service")
        group = ReentrantCallbackGroup()
        self.ticks = 0
        self.create_service(AddTwoInts, "slow_add", self.add, callback_group=group)
        self.create_timer(0.1, self.tick, callback_group=group)

    def add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f"tick {self.ticks}")


if __name__ == "__main__":
    run_threaded(ConcurrentService, threads=4)
