"""The log of the learner's node, or how to get one."""

from __future__ import annotations

import time

from textual.app import ComposeResult
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from tutor.tui.node import NodeState, Phase
from tutor.tui.widgets.line_view import Row
from tutor.tui.widgets.log_view import LogView


class LogPane(Vertical):
    """A line on the node, and its log below."""

    DEFAULT_CSS = """
    LogPane {
        background: $surface;
        & > #log-head { height: 1; background: $panel; padding: 0 1; text-wrap: nowrap; text-overflow: ellipsis; }
    }
    """

    def compose(self) -> ComposeResult:
        yield Static("no node yet", id="log-head")
        yield Static(
            Content.assemble(
                ("Nothing runs yet\n\n", "bold $foreground"),
                "Press ",
                ("r", "bold $accent"),
                " to run your node; what it logs and prints comes here.",
            ),
            id="log-empty",
        )
        yield LogView(id="log-view")

    def show(self, state: NodeState, domain: int) -> None:
        """Show a node and its log."""
        self.add_class("-filled")
        head = Content.assemble(*_head(state), (f"   domain {domain}", "$quiet"))
        self.query_one("#log-head", Static).update(head)
        tail: Row = ()
        if state.phase is Phase.ENDED:
            mark, kind = ("!", "error") if state.failed else ("■", "quiet")
            at = time.strftime("%H:%M:%S")
            tail = ((f" {mark}      {at}  ", kind), (f"{state.file}: {state.note}", kind))
        self.query_one(LogView).show_log(state.lines, state.dropped, tail)


def _head(state: NodeState) -> list[tuple[str, str]]:
    if state.phase is Phase.RUNNING:
        return [("● running  ", "bold $good"), (state.file, "bold")]
    if state.phase is Phase.ENDED:
        ink = "$bad" if state.failed else "$quiet"
        return [
            ("! ended  " if state.failed else "■ ended  ", f"bold {ink}"),
            (state.file, "bold"),
            (f"  {state.note}", ink),
        ]
    return [(f"◐ {state.phase.value}  ", "bold $warn"), (state.file, "bold")]
