"""Reports: one result object, and a renderer for each format."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from tutor.judge.result import Report

FORMATS = ("text", "json", "junit", "markdown")

_MODULES = {
    "text": "tutor.report.text",
    "json": "tutor.report.json_report",
    "junit": "tutor.report.junit",
    "markdown": "tutor.report.markdown",
}


def renderer_of(format: str) -> Callable[..., str]:
    """Return the renderer of one of `FORMATS`, imported on demand: importing rich alone takes 0.1 s."""
    renderer: Callable[..., str] = import_module(_MODULES[format]).render
    return renderer


def render(report: Report, format: str, *, color: bool = False, width: int = 100) -> str:
    """Render `report` in one of `FORMATS`; the text ends with a newline.

    `color` (terminal colours) and `width` (the column at which lines wrap) apply to "text" only.
    """
    renderer = renderer_of(format)
    return renderer(report, color=color, width=width) if format == "text" else renderer(report)
