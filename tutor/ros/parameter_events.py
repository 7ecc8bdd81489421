"""Watches parameter changes through /parameter_events."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from typing import Any

from rclpy.qos import qos_profile_parameter_events

from tutor.ros.interfaces import interface_class
from tutor.ros.observer import Observer


def watch_changes(observer: Observer, on_change: Callable[[str], None]) -> None:
    """Call `on_change(node)` on the event loop whenever a node reports that one of its parameters changed."""
    loop = asyncio.get_running_loop()

    def on_event(event: Any) -> None:
        with contextlib.suppress(RuntimeError):  # the loop is closed
            loop.call_soon_threadsafe(on_change, event.node)

    event_type = interface_class("rcl_interfaces/msg/ParameterEvent")
    observer.node.create_subscription(event_type, "/parameter_events", on_event, qos_profile_parameter_events)
