"""Messages compared by their wording."""

from __future__ import annotations

import re


def shape(text: str) -> str:
    """A message without its numbers: two messages of one shape come from the same line of code, as like as not."""
    return re.sub(r"-?\d+(\.\d+)?", "#", text)
