"""The facts gathered from a greeter."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.judge.trace import Trace


@dataclass(frozen=True, slots=True)
class Greeting:
    """The first text, or None if none arrived within `limit_s` seconds, and the whole run."""

    text: str | None
    limit_s: float
    trace: Trace
