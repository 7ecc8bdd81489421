"""Runs the engine for `ros-tutor check`: shows what it does, and stops it cleanly on Ctrl+C."""

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
    """`tutor.engine.check`."""

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
    """What is shown while the engine works."""

    def show(self, event: Event) -> None:
        """Take in one event."""

    def stopping(self) -> None:
        """The learner asked to stop; say that it takes a moment."""

    def close(self) -> None:
        """Leave the terminal tidy."""


class NoDisplay:
    """A display for streams that nobody watches."""

    def show(self, event: Event) -> None:
        """Show nothing."""

    def stopping(self) -> None:
        """Say it in a line."""
        terminal.say("stopping what was started")

    def close(self) -> None:
        """There is nothing to tidy."""


def judge(
    engine: Engine, submissions: Sequence[Submission], course: Course, only: frozenset[str] | None, display: Display
) -> Report | None:
    """Run the engine to its end; None where it was interrupted and has cleaned up."""
    return interruptible(lambda: engine(submissions, course, only=only, on_event=display.show), display)


def interruptible[T](work: Callable[[], Coroutine[None, None, T]], display: Display) -> T | None:
    """Run `work` to its end; None where it was interrupted and has cleaned up. The display is closed in any case."""
    try:
        return asyncio.run(_until_stopped(work, display))
    finally:
        display.close()


async def _until_stopped[T](work: Callable[[], Coroutine[None, None, T]], display: Display) -> T | None:
    task = asyncio.ensure_future(work())
    interrupted = False

    def stop() -> None:
        nonlocal interrupted
        if not interrupted:  # an impatient second Ctrl+C must not break off the clean-up
            interrupted = True
            display.stopping()
            task.cancel()

    loop = asyncio.get_running_loop()
    for number in _STOP_SIGNALS:
        loop.add_signal_handler(number, stop)
    try:
        return await task
    except asyncio.CancelledError:
        if not interrupted:
            raise RuntimeError("the check was cancelled, and nobody asked for it") from None
        return None
    finally:
        for number in _STOP_SIGNALS:
            loop.remove_signal_handler(number)


def display_for(course: Course, *, report_follows: bool) -> Display:
    """A live display where stderr is a terminal. `report_follows`: it makes room for the report at the end."""
    if not terminal.can_animate(sys.stderr):
        return NoDisplay()
    from tutor.cli.progress_display import ProgressDisplay  # rich: a tenth of a second

    return ProgressDisplay(course, vanishing=report_follows)
