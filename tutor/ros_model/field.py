"""The fields of messages and requests."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Field:
    """One leaf field: its dotted path, its ROS type, and its default as text."""

    path: str
    type: str
    default: str
