"""The fields of a message."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Field:
    """One leaf of a request: its path with dots, its type as ROS names it, and its default as text."""

    path: str
    type: str
    default: str
