"""Attempts over time: when, what the verdict was, how much had passed."""

from __future__ import annotations

from textual.content import Content

from tutor.content import Lesson
from tutor.judge.verdict import Status
from tutor.tui import wording
from tutor.workspace import Attempt, ExerciseProgress

BAR = 10
"""Cells of the bar of passed criteria."""


def history(lesson: Lesson, progress: ExerciseProgress, *, most: int) -> Content:
    """The latest attempts, the latest first, one in a line."""
    if not progress.attempts:
        return Content.styled("No attempts yet. F9 checks your node.", "$quiet")
    required = [c.id for c in lesson.criteria if not c.bonus]
    lines = [_line(attempt, required) for attempt in reversed(progress.attempts[-most:])]
    count = len(progress.attempts)
    head = f"{count} attempt{'' if count == 1 else 's'}"
    if progress.is_passed:
        number = next((n for n, a in enumerate(progress.attempts, 1) if a.is_pass), 0)
        head += f", passed at number {number}" if number else ", passed"
    return Content("\n").join([Content.styled(head, "bold"), *lines])


def _line(attempt: Attempt, required: list[str]) -> Content:
    asked = attempt.judged_of(required)
    met = sum(id in attempt.passed for id in asked)
    full = round(BAR * met / max(1, len(asked)))
    passed = attempt.verdict is Status.PASSED
    ink = wording.INKS[attempt.verdict]
    missed = [id for id in asked if id not in attempt.passed]
    about = "" if passed or not missed else f"  not yet: {', '.join(missed)}"
    if not attempt.whole:
        about += f"  (only {', '.join(attempt.judged or asked)})"
    return Content.assemble(
        (f"{wording.when(attempt.at)}  ", "$quiet"),
        (f"{wording.MARKS[attempt.verdict]} ", f"bold {ink}"),
        ("━" * full, ink),
        ("━" * (BAR - full), "$line"),
        f" {met} of {len(asked)}",
        (about, "$quiet"),
    )
