"""Asks a service and waits for the answer, so that Ctrl+C works meanwhile."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from tutor.errors import CommandError

if TYPE_CHECKING:
    from rclpy.task import Future

    from tutor.bundled_ros.ros2.domain import Domain

SLICE_S = 0.1
REMARK_AFTER_S = 6.0
"""After this long, a wait without a limit is reported to the user, on stderr."""


def wait_for_answer(domain: Domain, future: Future, *, remark: Callable[[], str] | None = None) -> Any:
    """The result of a call, however long it takes; after some seconds `remark` says once what is waited for.

    Raises CommandError where the call fails.
    """
    from rclpy.executors import SingleThreadedExecutor

    executor = SingleThreadedExecutor(context=domain.node.context)
    executor.add_node(domain.node)
    try:
        started = time.monotonic()
        while not future.done():
            executor.spin_once(timeout_sec=SLICE_S)
            if remark is not None and time.monotonic() > started + REMARK_AFTER_S:
                print(remark(), file=sys.stderr, flush=True)
                remark = None
    finally:
        executor.remove_node(domain.node)
        executor.shutdown()
    if future.result() is None:
        raise CommandError(f"Exception while calling service: {future.exception()!r}")
    return future.result()


def wait_until(
    ready: Callable[[], bool], *, limit_s: float | None = None, remark: Callable[[], str] | None = None
) -> bool:
    """Wait until something is so, `limit_s` seconds at most (None: as long as it takes); whether it is."""
    started = time.monotonic()
    while not ready():
        waited = time.monotonic() - started
        if limit_s is not None and waited > limit_s:
            return False
        if remark is not None and waited > REMARK_AFTER_S:
            print(remark(), file=sys.stderr, flush=True)
            remark = None
        time.sleep(SLICE_S / 10)
    return True
