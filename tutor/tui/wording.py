"""How results, progress and times are worded on screen: always a mark or a word, never colour alone."""

from __future__ import annotations

from datetime import datetime
from textwrap import shorten

from tutor.content import Difficulty, Lesson
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.workspace import ExerciseState, State

MARKS = {Status.PASSED: "✓", Status.FAILED: "✗", Status.SKIPPED: "-", Status.ERROR: "!"}
"""Each is one cell wide in every terminal font that matters."""

STATUS_COLOURS = {Status.PASSED: "$good", Status.FAILED: "$bad", Status.SKIPPED: "$quiet", Status.ERROR: "$warn"}
"""The theme's colour for each status; it always comes with a mark."""

LEVELS = {Difficulty.EASY: "●○○ easy", Difficulty.MEDIUM: "●●○ medium", Difficulty.CHALLENGE: "●●● challenge"}


def label(lesson: Lesson) -> str:
    """Return the exercise's id as the course writes it, e.g. "I1.1", or "lamps:I1.1" beside another I1.1."""
    course, colon, id = lesson.id.rpartition(":")
    return f"{course}{colon}{id.upper()}"


def progress_label(found: ExerciseState) -> tuple[str, str]:
    """Return a lesson's progress as (mark, words). The mark is ✓ only if the whole exercise has been passed."""
    return {
        State.PASSED: ("✓", "passed"),
        State.NOT_PASSED: ("◐", f"{found.count} met"),
        State.STARTED: ("◐", "started"),
        State.NOT_STARTED: ("○", "new"),
    }[found.state]


def summary(result: ExerciseResult) -> str:
    """Summarize a check's outcome in one line."""
    required = [c for c in result.criteria if not c.bonus]
    bonus = [c for c in result.criteria if c.bonus]
    text = f"{sum(c.verdict.passed for c in required)} of {len(required)} passed"
    if bonus:
        text += f" · bonus {sum(c.verdict.passed for c in bonus)} of {len(bonus)}"
    return f"{text} · {result.duration_s:.1f} s"


def format_time(at: str) -> str:
    """Format an ISO 8601 time from the progress file in the local time zone; return any other text unchanged."""
    try:
        moment = datetime.fromisoformat(at).astimezone()
    except ValueError:
        return at
    today = datetime.now().astimezone().date() == moment.date()
    return f"today {moment:%H:%M}" if today else f"{moment:%Y-%m-%d %H:%M}"


def key_hint(name: str, *, typing: bool) -> str:
    """Return what to press for a one-letter command: with the focus in the editor, that needs Esc first."""
    return f"Esc, then {name}" if typing else name


def shorten_to(text: str, width: int) -> str:
    """Shorten a text to at most `width` columns, at a word boundary and with an ellipsis."""
    return text if len(text) <= width else shorten(text, max(1, width), placeholder=" …")
