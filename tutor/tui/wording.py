"""How things are said on the screen: a mark (never colour alone), a word, and a short form of paths and times."""

from __future__ import annotations

from datetime import datetime
from textwrap import shorten

from tutor.content import Difficulty, Lesson
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.workspace import ExerciseState, State

MARKS = {Status.PASSED: "✓", Status.FAILED: "✗", Status.SKIPPED: "-", Status.ERROR: "!"}
"""One cell wide in every terminal font that matters."""

INKS = {Status.PASSED: "$good", Status.FAILED: "$bad", Status.SKIPPED: "$quiet", Status.ERROR: "$warn"}
"""The theme's colour for each status; it never stands alone, a mark is with it."""

LEVELS = {Difficulty.EASY: "●○○ easy", Difficulty.MEDIUM: "●●○ medium", Difficulty.CHALLENGE: "●●● challenge"}


def label(lesson: Lesson) -> str:
    """The exercise's id as the course writes it."""
    return lesson.id.upper()


def progress_label(found: ExerciseState) -> tuple[str, str]:
    """How a lesson stands: a mark and words. The mark is ✓ only where the whole exercise has been passed."""
    return {
        State.PASSED: ("✓", "passed"),
        State.NOT_PASSED: ("◐", f"{found.count} met"),
        State.STARTED: ("◐", "started"),
        State.NOT_STARTED: ("○", "new"),
    }[found.state]


def summary(result: ExerciseResult) -> str:
    """The outcome of a check in one line."""
    required = [c for c in result.criteria if not c.bonus]
    bonus = [c for c in result.criteria if c.bonus]
    text = f"{sum(c.verdict.passed for c in required)} of {len(required)} passed"
    if bonus:
        text += f" · bonus {sum(c.verdict.passed for c in bonus)} of {len(bonus)}"
    return f"{text} · {result.duration_s:.1f} s"


def when(at: str) -> str:
    """A time of the progress file, as the learner's clock shows it."""
    try:
        moment = datetime.fromisoformat(at).astimezone()
    except ValueError:
        return at
    today = datetime.now().astimezone().date() == moment.date()
    return f"today {moment:%H:%M}" if today else f"{moment:%Y-%m-%d %H:%M}"


def key(name: str, *, typing: bool) -> str:
    """What to press for a command of one letter, which types while the editor has the focus."""
    return f"Esc, then {name}" if typing else name


def fitted(text: str, width: int) -> str:
    """A text in this many columns; where it is too long, whole words of it and an ellipsis."""
    return text if len(text) <= width else shorten(text, max(1, width), placeholder=" …")
