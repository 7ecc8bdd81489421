import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Configured(Node):
    """A node that sets itself up as soon as it exists."""

    calls = None
    clock_work = None

    def __init__(self, name):
        super().__init__(name)
        self.set_up()


class SlowAdder(Configured):
    def __init__(self):
        super().__init__("slow_adder")
        self.calls = ReentrantCallbackGroup()
        self.clock_work = MutuallyExclusiveCallbackGroup()

    def set_up(self):
        self.beats = 0
        self.create_service(AddTwoInts, "slow_add", self.add, callback_group=self.calls)
        self.create_timer(0.1, self.beat, callback_group=self.clock_work)

    def beat(self):
        self.beats += 1
        self.get_logger().info(f"beat {self.beats}")

    def add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=5)
    executor.add_node(SlowAdder())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
