#!/usr/bin/env python3
"""Offers /slow_add, which takes three seconds, while a 10 Hz timer keeps ticking."""

import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

WORK_S = 3.0
TICK_S = 0.1
INT64_MIN, INT64_MAX = -(2**63), 2**63 - 1


class ConcurrentService(Node):
    """Adds two numbers slowly, for several callers at once, and never misses a tick."""

    def __init__(self) -> None:
        super().__init__("concurrent_service")
        # Reentrant: calls to the service may overlap. The timer has its own group, so that no call can hold it up.
        self.service_group = ReentrantCallbackGroup()
        self.timer_group = ReentrantCallbackGroup()
        self.stopping = threading.Event()
        self.ticks = 0
        self.create_service(AddTwoInts, "slow_add", self.slow_add, callback_group=self.service_group)
        self.create_timer(TICK_S, self.tick, callback_group=self.timer_group)
        self.get_logger().info("Ready: /slow_add")

    def slow_add(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Answer with a + b after three seconds. Several threads may be in here, so keep nothing in self."""
        self.get_logger().info(f"Working on {request.a} + {request.b}")
        # Like time.sleep(WORK_S), but returns at once when the node has to stop.
        if not self.stopping.wait(WORK_S):
            self.answer(request, response)
        return response

    def answer(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> None:
        """Log the sum, and put it, or the nearest number that fits into an int64, into the response."""
        result = request.a + request.b
        # Python's integers have no limit, but an int64 has: a larger result would raise OverflowError and end the node.
        response.sum = max(INT64_MIN, min(result, INT64_MAX))
        question = f"{request.a} + {request.b}"
        if response.sum == result:
            self.get_logger().info(f"{question} = {result}")
        else:
            self.get_logger().error(f"{question} = {result} does not fit into an int64: answering {response.sum}")

    def tick(self) -> None:
        """Count, and log every tenth tick, which is once per second."""
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f"Tick {self.ticks}")


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = ConcurrentService()
    # Enough threads for several slow calls at once, with one left over for the timer.
    executor = MultiThreadedExecutor(num_threads=8)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        node.stopping.set()  # Python ends only when all threads have ended: wake those that still wait.
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
