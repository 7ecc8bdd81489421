"""Runs the engine for `ros-tutor check`, shows its progress, and stops it cleanly on Ctrl+C."""

from __future__ import annotations

import asyncio
import signal
import sys
from collections.abc import Callable, Coroutine, Sequence
from typing import TYPE_CHECKING, Protocol

from tutor.cli import terminal
from tutor.judge.events import Event
from tutor.judge.result import Report
from tutor.judge.submission import Submission

if TYPE_CHECKING:
    from tutor.content import Course

_STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Engine(Protocol):
    """The signature of `tutor.engine.run_check`."""

    def __call__(
        self,
        submissions: Sequence[Submission],
        course: Course,
        *,
        only: frozenset[str] | None,
        on_event: Callable[[Event], None],
    ) -> Coroutine[None, None, Report]:
        """Judge the submissions."""


class Display(Protocol):
    """Shows progress while the engine works."""

    def show(self, event: Event) -> None:
        """Process one event."""

    def stopping(self) -> None:
        """Tell the learner, who pressed Ctrl+C, that stopping takes a moment."""

    def close(self) -> None:
        """Restore the terminal."""


class NoDisplay:
    """A display for streams that are not a terminal."""

    def show(self, event: Event) -> None:
        """Show nothing."""

    def stopping(self) -> None:
        """Print one line."""
        terminal.say("stopping everything that was started")

    def close(self) -> None:
        """Do nothing."""


def judge(
    engine: Engine, submissions: Sequence[Submission], course: Course, only: frozenset[str] | None, display: Display
) -> Report | None:
    """Run the engine to completion; return None if it was interrupted, after it has cleaned up."""
    return interruptible(lambda: engine(submissions, course, only=only, on_event=display.show), display)


def interruptible[T](work: Callable[[], Coroutine[None, None, T]], display: Display) -> T | None:
    """Run `work` to completion; return None if it was interrupted, after its cleanup. Always closes the display."""
    try:
        return asyncio.run(_until_stopped(work, display))
    finally:
        display.close()


async def _until_stopped[T](work: Callable[[], Coroutine[None, None, T]], display: Display) -> T | None:
    task = asyncio.ensure_future(work())
    interrupted = False

    def stop() -> None:
        nonlocal interrupted
        if not interrupted:  # an impatient second Ctrl+C must not abort the cleanup
            interrupted = True
            display.stopping()
            task.cancel()

    loop = asyncio.get_running_loop()
    for signum in _STOP_SIGNALS:
        loop.add_signal_handler(signum, stop)
    try:
        return await task
    except asyncio.CancelledError:
        if not interrupted:
            raise RuntimeError("the check was cancelled without a stop signal") from None
        return None
    finally:
        for signum in _STOP_SIGNALS:
            loop.remove_signal_handler(signum)


def display_for(course: Course, *, report_follows: bool) -> Display:
    """Return a live display if stderr is a terminal. With `report_follows`, it erases itself before the report."""
    if not terminal.can_animate(sys.stderr):
        return NoDisplay()
    from tutor.cli.progress_display import ProgressDisplay  # imported late: importing rich takes 0.1 s

    return ProgressDisplay(course, vanishing=report_follows)
