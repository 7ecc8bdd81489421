"""The self-assessment checklist as a document to keep and to hand in."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from tutor.report.assessment import Assessment

SUFFIXES = {"markdown": ".md", "json": ".json", "html": ".html"}
"""The formats, each with the suffix of its files."""

FORMATS = tuple(SUFFIXES)

TITLE = "Self-assessment checklist"


def format_of(path: Path) -> str | None:
    """The format that a file's suffix stands for, or None."""
    known = {suffix: format for format, suffix in SUFFIXES.items()} | {".markdown": "markdown", ".htm": "html"}
    return known.get(path.suffix.lower())


def render_checklist(assessment: Assessment, format: str, *, at: str) -> str:
    """Write the checklist in one of `FORMATS`; the text ends with a line's end.

    `at` is when the document is made (UTC, ISO 8601).
    """
    # Late: only one of them is needed.
    render: Callable[..., str] = import_module(f"tutor.report.checklist_{format}").render
    return render(assessment, at=at)
