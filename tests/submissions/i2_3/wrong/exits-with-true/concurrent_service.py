import sys
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__("concurrent_service")
        group = ReentrantCallbackGroup()
        self.ticks = 0
        self.create_service(AddTwoInts, "slow_add", self.slow_add, callback_group=group)
        self.create_timer(0.1, self.tick, callback_group=group)

    def slow_add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.ticks += 1
        self.get_logger().info(f"tick {self.ticks}")


def run():
    """Return whether all went well."""
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(ConcurrentService())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        return True
    finally:
        rclpy.try_shutdown()
    return False


if __name__ == "__main__":
    sys.exit(run())
