import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__("concurrent_service")
        # a group for each of them
        self.groups = dict.fromkeys(("adder", "clock"), MutuallyExclusiveCallbackGroup())
        self.ticks = 0
        self.service = self.create_service(AddTwoInts, "slow_add", self.add, callback_group=self.groups["adder"])
        self.timer = self.create_timer(0.1, self.tick, callback_group=self.groups["clock"])

    def add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f"tick {self.ticks}")


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
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
