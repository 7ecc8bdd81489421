"""Runs asynchronous work until it is done or a stop signal arrives: Ctrl+C, SIGTERM or SIGHUP."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable, Coroutine, Sequence

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stopped(Exception):
    """A stop signal ended the work, which has cleaned up."""


def run_until_stopped[T](work: Callable[[], Coroutine[None, None, T]], on_stop: Callable[[], None] = lambda: None) -> T:
    """Run `work` in a new event loop and return its result. Call this in the main thread.

    The first stop signal calls `on_stop` and cancels the work; once that has cleaned up, Stopped is raised. Further
    signals are ignored, so an impatient second Ctrl+C does not abort the cleanup. A signal that arrives while the loop
    is being set up is kept for it: a KeyboardInterrupt there would make Python report objects that were never awaited.
    """
    early: list[int] = []
    previous = {number: signal.signal(number, lambda number, _: early.append(number)) for number in STOP_SIGNALS}
    try:
        return asyncio.run(_run(work, on_stop, early))
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler or signal.SIG_DFL)


async def _run[T](work: Callable[[], Coroutine[None, None, T]], on_stop: Callable[[], None], early: Sequence[int]) -> T:
    task = asyncio.ensure_future(work())
    stopped = False

    def stop() -> None:
        nonlocal stopped
        if not stopped and not task.done():
            stopped = True
            on_stop()
            task.cancel()

    loop = asyncio.get_running_loop()
    for number in STOP_SIGNALS:  # the loop removes these handlers when it is closed
        loop.add_signal_handler(number, stop)
    if early:
        stop()
    try:
        return await task
    except asyncio.CancelledError:
        if not stopped:
            raise RuntimeError("the work was cancelled without a stop signal") from None
        raise Stopped from None
