"""Exports the self-assessment checklist as a document to keep or hand in."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from tutor.report.assessment import Assessment

SUFFIXES = {"markdown": ".md", "json": ".json", "html": ".html"}
"""File suffix by format."""

FORMATS = tuple(SUFFIXES)

TITLE = "Self-assessment checklist"


def format_of(path: Path) -> str | None:
    """Return the format of a file by its suffix, or None if it is unknown."""
    known = {suffix: format for format, suffix in SUFFIXES.items()} | {".markdown": "markdown", ".htm": "html"}
    return known.get(path.suffix.lower())


def render_checklist(assessment: Assessment, format: str, *, at: str) -> str:
    """Render the checklist in one of `FORMATS`; the text ends with a newline.

    `at` is the time of the export (UTC, ISO 8601).
    """
    # Imported late: only one of the renderers is needed.
    render: Callable[..., str] = import_module(f"tutor.report.checklist_{format}").render
    return render(assessment, at=at)
