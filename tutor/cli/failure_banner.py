"""The first failure of a check that goes on, above everything else on the terminal: its cause, and the next step."""

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


def first_failure(name: str, result: CriterionResult, console: Console, most: int) -> list[Text]:
    """The banner in at most this many rows of one line; `name` is the criterion's, with its exercise where needed."""
    verdict = result.verdict
    head = Text(f"{MARKS[verdict.status]} {name} failed after {seconds(result.duration_s)}", f"bold {_RED}")
    said = [Text(one_line(verdict.cause or verdict.observed, 1000), "bold")]
    if verdict.hint:
        said.append(Text.assemble(("next step: ", "dim"), printable(verdict.hint).strip()))
    rows = [head]
    for text in said:
        rows += text.wrap(console, max(20, console.width - len(_MARGIN) - 1))
    if len(rows) > most:
        rows = [*rows[: max(1, most - 1)], Text("...", "dim")]
    return [*(Text.assemble((_MARGIN, _RED), row) for row in rows), Text()]
