"""Damaged files of ours are set aside, so that nothing is lost."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from tutor.errors import StorageError


def set_aside(path: Path) -> Path:
    """Rename a damaged file, and return its new path. Raises StorageError."""
    aside = path.with_name(f"{path.name}.damaged-{datetime.now(UTC):%Y%m%dT%H%M%S%fZ}")
    try:
        path.rename(aside)
    except OSError as error:
        raise StorageError.of(f"rename {path}", error) from error
    return aside
