"""Waiting for services and their responses in a way that Ctrl+C can interrupt."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from tutor.errors import CommandError

if TYPE_CHECKING:
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.task import Future

    from tutor.bundled_ros.ros2.domain import Domain

SPIN_TIMEOUT_S = 0.1
"""Timeout of one `spin_once()`, so that Ctrl+C is handled soon."""

NOTICE_AFTER_S = 6.0
"""How long an unlimited wait goes on before the user is told about it on stderr."""


def make_executor(node: Node) -> SingleThreadedExecutor:
    """Return an executor for a node. Ctrl+C waits until it is complete: rclpy cannot delete half of one."""
    from rclpy.executors import SingleThreadedExecutor

    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        executor = SingleThreadedExecutor(context=node.context)
        executor.add_node(node)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
    return executor


def wait_for_answer(domain: Domain, future: Future, *, notice: Callable[[], str] | None = None) -> Any:
    """Spin until a call has its result, and return it, however long that takes.

    After NOTICE_AFTER_S seconds, the text that `notice` returns is printed once. Raises CommandError if the call fails.
    """
    executor = make_executor(domain.node)
    try:
        started = time.monotonic()
        while not future.done():
            executor.spin_once(timeout_sec=SPIN_TIMEOUT_S)
            if notice is not None and time.monotonic() > started + NOTICE_AFTER_S:
                print(notice(), file=sys.stderr, flush=True)
                notice = None
    finally:
        executor.remove_node(domain.node)
        executor.shutdown()
    if future.result() is None:
        raise CommandError(f"Exception while calling service: {future.exception()!r}")
    return future.result()


def wait_until(
    ready: Callable[[], bool], *, limit_s: float | None = None, notice: Callable[[], str] | None = None
) -> bool:
    """Poll until `ready` is true, for at most `limit_s` seconds (None: forever). Return whether it became true."""
    started = time.monotonic()
    while not ready():
        waited = time.monotonic() - started
        if limit_s is not None and waited > limit_s:
            return False
        if notice is not None and waited > NOTICE_AFTER_S:
            print(notice(), file=sys.stderr, flush=True)
            notice = None
        time.sleep(SPIN_TIMEOUT_S / 10)
    return True
