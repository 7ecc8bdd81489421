"""The facts gathered from a greeter."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Greeting:
    """The first text, or None if none arrived within `limit_s` seconds."""

    text: str | None
    limit_s: float
