"""Wording of numbers in messages, and comparison of log messages by their wording."""

from __future__ import annotations

import re


def counted(number: int, noun: str) -> str:
    """A number of things in words: "1 line", "3 lines"."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def shape(text: str) -> str:
    """A message with its numbers blanked out: messages of the same shape likely come from the same line of code."""
    return re.sub(r"-?\d+(\.\d+)?", "#", text)
