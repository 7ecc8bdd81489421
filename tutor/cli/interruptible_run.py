"""Runs the engine for `ros-tutor check`, shows its progress, and stops it cleanly on Ctrl+C."""

from __future__ import annotations

import sys
from collections.abc import Callable, Coroutine, Sequence
from typing import TYPE_CHECKING, Protocol

from tutor.cli import terminal
from tutor.judge.events import Event
from tutor.judge.result import Report
from tutor.judge.submission import Submission
from tutor.stop_signals import Stopped, run_until_stopped

if TYPE_CHECKING:
    from tutor.content import Course


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
        return run_until_stopped(work, display.stopping)
    except Stopped:
        return None
    finally:
        display.close()


def display_for(course: Course, *, report_follows: bool) -> Display:
    """Return a live display if stderr is a terminal. With `report_follows`, it erases itself before the report."""
    if not terminal.can_animate(sys.stderr):
        return NoDisplay()
    from tutor.cli.progress_display import ProgressDisplay  # imported late: importing rich takes 0.1 s

    return ProgressDisplay(course, vanishing=report_follows)
