"""The launch's own ROS node, created when an action first needs it."""

from __future__ import annotations

import importlib
import os
import threading
from collections.abc import Sequence
from typing import Any

from launch._unsupported import refuse
from launch.event_handlers import OnShutdown
from launch.launch_context import LaunchContext


class ROSAdapter:
    """A node in its own context, spun in a background thread."""

    def __init__(self, *, argv: Sequence[str] | None = None, autostart: bool = True) -> None:
        self._argv = list(argv or ())
        self._is_running = False
        self._ros_context: Any = None
        self._ros_node: Any = None
        self._ros_executor: Any = None
        if autostart:
            self.start()

    @property
    def argv(self) -> list[str]:
        return self._argv

    @property
    def ros_context(self) -> Any:
        return self._ros_context

    @property
    def ros_node(self) -> Any:
        return self._ros_node

    @property
    def ros_executor(self) -> Any:
        return self._ros_executor

    def start(self) -> None:
        """Create the node and spin it. Raises RuntimeError if it is already running."""
        if self._is_running:
            raise RuntimeError("Cannot start a ROS adapter that is already running")
        try:
            rclpy = importlib.import_module("rclpy")
            executors = importlib.import_module("rclpy.executors")
        except ImportError:
            refuse("a launch file with a ROS node of its own, where rclpy is missing,")
        self._ros_context = rclpy.Context()
        rclpy.init(args=self._argv, context=self._ros_context)
        self._ros_node = rclpy.create_node(f"launch_ros_{os.getpid()}", context=self._ros_context)
        self._ros_executor = executors.SingleThreadedExecutor(context=self._ros_context)
        self._ros_executor.add_node(self._ros_node)
        self._is_running = True
        self._shutdown_exception = executors.ExternalShutdownException
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._ros_executor.spin()
        except self._shutdown_exception:
            return

    def shutdown(self) -> None:
        """Destroy the node. Raises RuntimeError if it is not running."""
        if not self._is_running:
            raise RuntimeError("Cannot shutdown a ROS adapter that is not running")
        self._is_running = False
        self._ros_context.try_shutdown()
        self._thread.join()
        self._ros_executor.shutdown()
        self._ros_node.destroy_node()


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the launch's adapter, created on the first call and shut down with the launch."""
    adapter: ROSAdapter | None = context.get_locals_as_dict().get("ros_adapter")
    if adapter is None:
        made = adapter = ROSAdapter()
        context.extend_globals({"ros_adapter": made})
        context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: made.shutdown()))
    return adapter


def get_ros_node(context: LaunchContext) -> Any:
    """Return the launch's own node."""
    return get_ros_adapter(context).ros_node
