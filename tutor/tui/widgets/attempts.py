"""The history of attempts at an exercise: when, which verdict, how many criteria passed."""

from __future__ import annotations

from textual.content import Content

from tutor.content import Lesson
from tutor.judge.verdict import Status
from tutor.tui import wording
from tutor.workspace import Attempt, ExerciseProgress

_BAR_CELLS = 10
"""Width in cells of the bar of passed criteria."""


def format_attempts(lesson: Lesson, progress: ExerciseProgress, *, max_count: int) -> Content:
    """Return the latest `max_count` attempts, newest first, one per line."""
    if not progress.attempts:
        return Content.styled("No attempts yet. F9 checks your node.", "$quiet")
    required = [c.id for c in lesson.criteria if not c.bonus]
    lines = [_line(attempt, required) for attempt in reversed(progress.attempts[-max_count:])]
    count = len(progress.attempts)
    head = f"{count} attempt{'' if count == 1 else 's'}"
    if progress.is_passed:
        number = next((n for n, a in enumerate(progress.attempts, 1) if a.is_pass), 0)
        head += f", passed at number {number}" if number else ", passed"
    return Content("\n").join([Content.styled(head, "bold"), *lines])


def _line(attempt: Attempt, required: list[str]) -> Content:
    judged_ids = attempt.judged_of(required)
    met = sum(id in attempt.passed for id in judged_ids)
    filled = round(_BAR_CELLS * met / max(1, len(judged_ids)))
    passed = attempt.verdict is Status.PASSED
    colour = wording.STATUS_COLOURS[attempt.verdict]
    missed = [id for id in judged_ids if id not in attempt.passed]
    note = "" if passed or not missed else f"  not yet: {', '.join(missed)}"
    if not attempt.whole:
        note += f"  (only {', '.join(attempt.judged or judged_ids)})"
    return Content.assemble(
        (f"{wording.format_time(attempt.at)}  ", "$quiet"),
        (f"{wording.MARKS[attempt.verdict]} ", f"bold {colour}"),
        ("━" * filled, colour),
        ("━" * (_BAR_CELLS - filled), "$line"),
        f" {met} of {len(judged_ids)}",
        (note, "$quiet"),
    )
