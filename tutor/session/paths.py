"""Paths, as people write them."""

from __future__ import annotations

from pathlib import Path


def short_path(path: Path) -> str:
    """A path with the home folder as ~."""
    try:
        return f"~/{path.relative_to(Path.home())}"
    except (RuntimeError, ValueError):  # it is elsewhere, or nobody knows the home
        return str(path)
