"""How evidence is said: "i2.1 validation passed, today"."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import date, datetime, timedelta

from tutor.report.assessment import Evidence, Source
from tutor.terminal_text import printable

Day = Callable[[str], str]
"""Says the day of a time of the progress file (UTC, ISO 8601)."""


def calendar_day(at: str) -> str:
    """The day by the learner's clock, "2026-11-21", for what is read later; where it is not a time, the text itself."""
    found = _local(at)
    return printable(at) if found is None else found.isoformat()


def near_day(at: str, today: date | None = None) -> str:
    """The day as people say it: "today", "yesterday", or the date."""
    found = _local(at)
    if found is None:
        return printable(at)
    now = today or datetime.now().astimezone().date()
    return {now: "today", now - timedelta(days=1): "yesterday"}.get(found, found.isoformat())


def describe_evidence(evidence: Sequence[Evidence], day: Day, most: int | None = None) -> list[str]:
    """One phrase for each exercise and day: "i2.1 runtime-params and timer passed, today".

    The first `most` of them only, where it is given; then how many more there are.
    """
    together: dict[tuple[str, str], list[str]] = {}
    for each in evidence:
        together.setdefault((each.exercise, day(each.at)), []).append(each.criterion)
    phrases = [
        f"{_name(exercise, criteria)} passed{f', {when}' if when else ''}"
        for (exercise, when), criteria in together.items()
    ]
    if most is None or len(phrases) <= most:
        return phrases
    return [*phrases[:most], f"{len(phrases) - most} more"]


def describe_sources(sources: Sequence[Source]) -> list[str]:
    """What could give evidence, one phrase for each exercise: "i2.1 runtime-params and timer"."""
    return [_name(source.exercise, source.criteria) for source in sources]


def _name(exercise: str, criteria: Sequence[str]) -> str:
    named = [criterion for criterion in criteria if criterion]
    *most, last = named or [""]
    return f"{exercise} {', '.join(most)}{' and ' if most else ''}{last}".strip()


def _local(at: str) -> date | None:
    try:
        return datetime.fromisoformat(at).astimezone().date()
    except (ValueError, OverflowError):
        return None
