import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__("concurrent_service")
        self.ticks = 0
        self.create_service(AddTwoInts, "slow_add", self.slow_add)
        self.create_timer(0.1, self.count)
        self.create_timer(1.0, self.show, callback_group=ReentrantCallbackGroup())

    def slow_add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def count(self):
        self.ticks += 1

    def show(self):
        self.get_logger().info(f"{self.ticks} ticks")


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(ConcurrentService())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
