"""`ros-tutor checklist`: show, tick, untick and export the self-assessment checklist."""

from __future__ import annotations

import argparse
import sys
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.cli import context, terminal
from tutor.cli.errors import PASSED
from tutor.errors import UsageError
from tutor.invocation import command

if TYPE_CHECKING:
    from tutor.content import Checklist
    from tutor.report.assessment import Assessment
    from tutor.workspace import Progress

_ACTIONS = ("show", "tick", "untick", "export")
_FORMATS = ("markdown", "json", "html")
_MAX_EVIDENCE = 2
"""Maximum number of exercises named as evidence for an item, so that its line stays short."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `[show | tick ITEM... | untick ITEM... | export] [--format] [--output]`."""
    actions = f"{', '.join(_ACTIONS[:-1])} or {_ACTIONS[-1]}"
    parser.add_argument("action", metavar="ACTION", nargs="?", choices=_ACTIONS, default="show", help=actions)
    parser.add_argument("items", metavar="ITEM", nargs="*", help="for tick and untick: an id that `show` prints")
    parser.add_argument("--format", choices=_FORMATS, help="for export (default: by FILE's suffix, else markdown)")
    parser.add_argument("--output", metavar="FILE", type=Path, help="for export: write there instead of to stdout")


def run(arguments: argparse.Namespace) -> int:
    """Tick or untick the items, then show the checklist; or export it."""
    from tutor.report.assessment import assess
    from tutor.workspace import versions_of

    _check_options(arguments)
    course = context.load_course(arguments)
    workspace = context.require_workspace(arguments)
    if arguments.action in ("tick", "untick"):
        for item in arguments.items:
            _require_known(item, course.checklist)
        if not workspace.exists:
            raise UsageError(
                f"ticks are kept in a workspace, and there is none yet; `{command('start', 'i1.1')}` makes one"
            )
        ticked = arguments.action == "tick"
        progress = workspace.progress(terminal.say).change(lambda before: _with_ticks(before, arguments.items, ticked))
    else:
        progress = context.read_progress(workspace)
    assessment = assess(course, progress, versions_of(course.lessons, workspace))
    if arguments.action == "export":
        _export(assessment, arguments.format, arguments.output)
    else:
        terminal.out(_render(assessment))
    return PASSED


def _check_options(arguments: argparse.Namespace) -> None:
    from tutor.report.checklist_formats import SUFFIXES, format_of

    takes_items = arguments.action in ("tick", "untick")
    if takes_items and not arguments.items:
        raise UsageError(f"checklist {arguments.action} needs an ITEM; `{command('checklist')}` shows them")
    if arguments.items and not takes_items:
        raise UsageError(f"checklist {arguments.action} takes no ITEM")
    if arguments.action != "export" and (arguments.format or arguments.output):
        raise UsageError("--format and --output go with `checklist export`")
    output = arguments.output
    if output is not None and output.suffix and arguments.format is None and format_of(output) is None:
        known = ", ".join(f"{format} ({suffix})" for format, suffix in SUFFIXES.items())
        raise UsageError(f"--output {output}: there is no format for {output.suffix}; the formats are {known}")


def _require_known(item: str, checklist: Checklist) -> None:
    known = [entry.id for entry in checklist.items]
    if item in known:
        return
    near = get_close_matches(item.lower(), known, n=1)
    guess = f" Did you mean {near[0]}?" if near else ""
    raise UsageError(f"there is no checklist item {item!r}.{guess} `{command('checklist')}` shows them all")


def _with_ticks(progress: Progress, items: list[str], ticked: bool) -> Progress:
    for item in items:
        progress = progress.with_tick(item, ticked)
    return progress


def _render(assessment: Assessment) -> str:
    from tutor.report.phrases import describe_evidence, near_day

    items = assessment.items
    width = max((len(item.id) for item in items), default=0)
    lines = []
    for group in assessment.groups:
        lines += [f"{terminal.style(group.title, '1', sys.stdout)}  {group.ticked} of {len(group.items)}"]
        for item in group.items:
            box = terminal.style("[x]", "32", sys.stdout) if item.ticked else "[ ]"
            shown = "; ".join(describe_evidence(item.evidence, near_day, max_items=_MAX_EVIDENCE))
            lines += [f"  {box} {item.id:{width}}  {item.text}{f'  ({shown})' if shown else ''}"]
        lines += [""]
    if assessment.ready:
        lines += [terminal.style(assessment.ready_title, "1", sys.stdout), *_wrap_lines(assessment.ready_text), ""]
    lines += [f"{assessment.ticked} of {len(items)} ticked. To tick one: {command('checklist', 'tick', 'ITEM')}"]
    return "\n".join(lines) + "\n"


def _wrap_lines(text: str) -> list[str]:
    return terminal.wrap(text, terminal.width(sys.stdout)).splitlines()


def _export(assessment: Assessment, format: str | None, output: Path | None) -> None:
    from tutor.report.checklist_formats import format_of, render_checklist
    from tutor.workspace import write_atomically
    from tutor.workspace.progress import now

    chosen = format or (output and format_of(output)) or "markdown"
    text = render_checklist(assessment, chosen, at=now())
    if output is None:
        terminal.out(text)
    else:
        write_atomically(output, text)
        terminal.say(f"wrote {output}")
