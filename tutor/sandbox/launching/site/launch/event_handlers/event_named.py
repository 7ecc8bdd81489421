"""A matcher by name."""

from __future__ import annotations

from collections.abc import Callable

from ..event import Event


def event_named(name: str) -> Callable[[Event], bool]:
    """True for events of this name."""
    return lambda event: event.name == name
