"""Reports: one result object, one renderer for each format."""

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
    """What writes one of `FORMATS`. Late, since only one of them is needed: rich alone takes a tenth of a second."""
    found: Callable[..., str] = import_module(_MODULES[format]).render
    return found


def render(report: Report, format: str, *, color: bool = False, width: int = 100) -> str:
    """Write `report` in one of `FORMATS`; the text ends with a line's end.

    `color` and `width` (in columns) matter to "text" only: terminal colours, and where lines wrap.
    """
    renderer = renderer_of(format)
    return renderer(report, color=color, width=width) if format == "text" else renderer(report)
