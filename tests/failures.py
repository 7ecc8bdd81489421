"""Failures as a report has them, for tests of what comes after judging."""

from __future__ import annotations

from collections.abc import Iterable

from tutor.judge.verdict import Status, Verdict


def failure(expected: str, observed: str, why: tuple[str, str, str], evidence: Iterable[str] = ()) -> Verdict:
    """A failed criterion. `why`: the mistake by name, what is said of it, and the next step."""
    name, text, step = why
    mistake = name.replace(" ", "-").lower()
    return Verdict(Status.FAILED, expected, observed, f"{name}: {text}", step, tuple(evidence), mistake)
