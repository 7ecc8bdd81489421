"""Finds the processes that a test submission leaves behind, by a text in their command lines."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path

LIMIT_S = 60.0
"""Longer than any check takes, so that whatever a check still ends itself has gone by then."""


async def find_leftovers(text: str) -> list[str]:
    """Return the command lines containing `text` that outlive every check; none for an empty text.

    Other submissions are judged at the same time; their processes end with their own checks.
    """
    left = _find_commands(text)
    deadline = time.monotonic() + LIMIT_S
    while left and time.monotonic() < deadline:
        await asyncio.sleep(0.2)
        running = _find_commands(text)
        left = {pid: command for pid, command in left.items() if running.get(pid) == command}
    return list(left.values())


def _find_commands(text: str) -> dict[str, str]:
    """Return the command lines that contain `text`, by pid; nothing for an empty `text`."""
    found: dict[str, str] = {}
    for path in Path("/proc").glob("[0-9]*/cmdline") if text else ():
        try:
            command = path.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if text in command:
            found[path.parent.name] = command
    return found
