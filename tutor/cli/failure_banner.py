"""The banner with the first failure of a running check, above everything else: its cause and the next step."""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from tutor.judge.result import CriterionResult
from tutor.judge.verdict import Status
from tutor.report.plain import MARKS, one_line, seconds
from tutor.report.text import STYLES
from tutor.terminal_text import printable

_RED = STYLES[Status.FAILED]
_MARGIN = "┃ "


def render_banner(name: str, result: CriterionResult, console: Console, max_rows: int) -> list[Text]:
    """Return the banner as at most `max_rows` one-line texts, plus an empty one.

    `name` is the criterion's id, preceded by its exercise's if several exercises are checked.
    """
    verdict = result.verdict
    head = Text(f"{MARKS[verdict.status]} {name} failed after {seconds(result.duration_s)}", f"bold {_RED}")
    body = [Text(one_line(verdict.cause or verdict.observed, 1000), "bold")]
    if verdict.step:
        body.append(Text.assemble(("next step: ", "dim"), printable(verdict.step).strip()))
    rows = [head]
    for text in body:
        rows += text.wrap(console, max(20, console.width - len(_MARGIN) - 1))
    if len(rows) > max_rows:
        rows = [*rows[: max(1, max_rows - 1)], Text("...", "dim")]
    return [*(Text.assemble((_MARGIN, _RED), row) for row in rows), Text()]
