"""The self-assessment checklist with its ticks, to show and to hand in."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from html import escape as escape_html

from tutor.content import Checklist
from tutor.report.markdown import escape as escape_markdown

FORMATS = ("markdown", "json", "html")
SCHEMA = "ros-tutor/checklist/1"
TITLE = "Self-assessment checklist"

Ticks = Mapping[str, str]
"""A ticked item's id, and when it was ticked (UTC, ISO 8601)."""

Evidence = Mapping[str, Sequence[str]]
"""For an item's id, the passed exercises that show it."""


def render_checklist(checklist: Checklist, ticks: Ticks, evidence: Evidence, format: str) -> str:
    """Write the checklist in one of `FORMATS`."""
    lines = {"markdown": _markdown, "json": _json, "html": _html}[format](checklist, ticks, evidence)
    return "\n".join(lines) + "\n"


def _markdown(checklist: Checklist, ticks: Ticks, evidence: Evidence) -> Iterator[str]:
    yield f"# {TITLE}"
    for group in checklist.groups:
        yield ""
        yield f"## {escape_markdown(group.title)}"
        yield ""
        for item in group.items:
            shown = f" ({_shown(evidence[item.id])})" if evidence.get(item.id) else ""
            yield f"- [{'x' if item.id in ticks else ' '}] {escape_markdown(item.text)}{shown}"


def _json(checklist: Checklist, ticks: Ticks, evidence: Evidence) -> Iterator[str]:
    groups = [
        {
            "id": group.id,
            "title": group.title,
            "items": [
                {
                    "id": item.id,
                    "text": item.text,
                    "ticked": item.id in ticks,
                    "ticked_at": ticks.get(item.id),
                    "passed": list(evidence.get(item.id, ())),
                }
                for item in group.items
            ],
        }
        for group in checklist.groups
    ]
    yield json.dumps({"schema": SCHEMA, "groups": groups}, ensure_ascii=False, indent=2)


def _html(checklist: Checklist, ticks: Ticks, evidence: Evidence) -> Iterator[str]:
    yield "<!DOCTYPE html>"
    yield '<html lang="en">'
    yield f'<head><meta charset="utf-8"><title>{TITLE}</title>'
    yield "<style>body{font-family:sans-serif;max-width:45rem;margin:2rem auto;padding:0 1rem}"
    yield "ul{list-style:none;padding:0}li{margin:.4rem 0}small{color:#555}</style></head>"
    yield "<body>"
    yield f"<h1>{TITLE}</h1>"
    for group in checklist.groups:
        yield f"<h2>{escape_html(group.title)}</h2>"
        yield "<ul>"
        for item in group.items:
            checked = " checked" if item.id in ticks else ""
            shown = f" <small>{escape_html(_shown(evidence[item.id]))}</small>" if evidence.get(item.id) else ""
            box = f'<input type="checkbox" disabled{checked}>'
            yield f"<li><label>{box} {escape_html(item.text)}</label>{shown}</li>"
        yield "</ul>"
    yield "</body>"
    yield "</html>"


def _shown(exercises: Sequence[str]) -> str:
    return f"passed {', '.join(exercises)}"
