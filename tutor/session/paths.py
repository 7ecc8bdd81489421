"""Paths as people write them."""

from __future__ import annotations

from pathlib import Path


def short_path(path: Path) -> str:
    """Return a path with the home directory abbreviated as ~."""
    try:
        return f"~/{path.relative_to(Path.home())}"
    except (RuntimeError, ValueError):  # ValueError: not below the home directory; RuntimeError: no home directory
        return str(path)
