"""Finds the line of a course's file that a problem is about."""

from __future__ import annotations

import re
from pathlib import Path


def find_line(file: Path, pattern: str) -> int | None:
    """Return the number, from 1, of the first line in which a regular expression is found; None if there is none."""
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return None
    return next((number for number, line in enumerate(lines, 1) if re.search(pattern, line)), None)


def find_word(file: Path, word: str) -> int | None:
    """Return the number of the first line that has `word`, not as a part of another; None if there is none."""
    return find_line(file, rf"(?<![\w-]){re.escape(word)}(?![\w-])")
