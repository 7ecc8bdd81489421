"""Slow adder with usage statistics."""
from __future__ import annotations

import threading
import time
from typing import Any

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

SERVICE_NAME = "slow_add"
PROCESSING_TIME_SEC = 3.0
TICK_PERIOD_SEC = 0.1


class ConcurrentServiceNode(Node):
    """Serves `slow_add` and keeps statistics about who used it."""

    def __init__(self) -> None:
        super().__init__("concurrent_service")
        self._service_group = MutuallyExclusiveCallbackGroup()
        self._timer_group = ReentrantCallbackGroup()

        self.srv = self.create_service(
            AddTwoInts,
            SERVICE_NAME,
            self._on_slow_add,
            callback_group=self._service_group,
        )
        self.timer = self.create_timer(
            TICK_PERIOD_SEC, self._on_tick, callback_group=self._timer_group
        )

        self._init_statistics()
        self.get_logger().info(f"Service {self.srv.srv_name} ready")

    # ---- statistics -------------------------------------------------------

    def _init_statistics(self) -> None:
        self._stats_lock = threading.Lock()
        self._tick = 0
        # service name -> calls, total seconds
        self._services: dict[str, dict[str, Any]] = {}

    def _count(self, name: str, seconds: float) -> None:
        with self._stats_lock:
            entry = self._services.setdefault(name, {"calls": 0, "seconds": 0.0})
            entry["calls"] += 1
            entry["seconds"] += seconds

    # ---- callbacks --------------------------------------------------------

    def _on_slow_add(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        start = time.monotonic()
        time.sleep(PROCESSING_TIME_SEC)
        response.sum = request.a + request.b
        self._count(SERVICE_NAME, time.monotonic() - start)
        return response

    def _on_tick(self) -> None:
        self._tick += 1
        if self._tick % 10 == 0:
            self.get_logger().info(f"Timer tick: {self._tick}")


def main() -> None:
    rclpy.init()
    node = ConcurrentServiceNode()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
