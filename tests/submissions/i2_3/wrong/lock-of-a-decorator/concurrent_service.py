#!/usr/bin/env python3
"""
Concurrent service node.

Thread safety:
    With a MultiThreadedExecutor several callbacks run at the same time, so
    every callback that touches the statistics is marked as @synchronized.
"""

import functools
import threading
import time
from dataclasses import dataclass

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import (
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

PROCESSING_TIME_SEC = 3.0
TIMER_PERIOD_SEC = 0.1
NUM_THREADS = 8


def synchronized(method):
    """Decorator: only one synchronized method of an object runs at a time."""

    @functools.wraps(method)
    def wrapper(self, *args, **kwargs):
        with self.state_lock:
            return method(self, *args, **kwargs)

    return wrapper


@dataclass
class Statistics:
    """Counters shared by all callbacks."""

    ticks: int = 0
    requests: int = 0
    busy_seconds: float = 0.0


class ConcurrentService(Node):
    """Slow service beside a fast timer."""

    def __init__(self) -> None:
        super().__init__("concurrent_service")
        self.state_lock = threading.RLock()
        self.statistics = Statistics()

        self.service_group = ReentrantCallbackGroup()
        self.timer_group = MutuallyExclusiveCallbackGroup()

        self.slow_service = self.create_service(
            AddTwoInts,
            "slow_add",
            self.handle_request,
            callback_group=self.service_group,
        )
        self.fast_timer = self.create_timer(
            TIMER_PERIOD_SEC,
            self.handle_tick,
            callback_group=self.timer_group,
        )
        self.get_logger().info("Concurrent service is ready")

    @synchronized
    def handle_request(self, request, response):
        """Process one request (takes three seconds)."""
        started = time.monotonic()
        self.statistics.requests += 1
        self.get_logger().info(
            f"Request {self.statistics.requests}: {request.a} + {request.b}"
        )
        time.sleep(PROCESSING_TIME_SEC)
        response.sum = request.a + request.b
        self.statistics.busy_seconds += time.monotonic() - started
        return response

    @synchronized
    def handle_tick(self) -> None:
        """Count the ticks, log one per second."""
        self.statistics.ticks += 1
        if self.statistics.ticks % 10 == 0:
            self.get_logger().info(f"Tick {self.statistics.ticks}")


def main() -> None:
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=NUM_THREADS)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
