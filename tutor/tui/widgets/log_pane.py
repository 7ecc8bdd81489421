"""The pane with the log of the learner's node and its filters; before the first run, how to start one."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from tutor.judge.trace import Level
from tutor.session.node import NodeState, Phase
from tutor.tui import loglines, messages
from tutor.tui.widgets.line_view import Row
from tutor.tui.widgets.log_view import LogView
from tutor.tui.widgets.steady_static import SteadyStatic
from tutor.tui.widgets.strip import TabStrip

LEVELS = (Level.DEBUG, Level.INFO, Level.WARN, Level.ERROR)


class LogPane(Vertical):
    """A status line for the node, a line of filters, and the log below."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "end_filter", "All lines", show=True, key_display="Esc"),
        Binding("left_square_bracket", "step(-1)", "Previous node", show=False),
        Binding("right_square_bracket", "step(1)", "Next node", show=False),
    ]
    DEFAULT_CSS = """
    LogPane {
        background: $surface;
        & > .log-line { height: 1; background: $panel; padding: 0 1; text-wrap: nowrap; text-overflow: ellipsis; }
        & Static { link-color: $foreground; link-style: underline; link-color-hover: $background; }
        & > #log-filter {
            display: none;
            height: 1;
            border: none;
            padding: 0 1;
            background: $background;
            &:focus { border: none; }
        }
        & > #log-tools { display: none; }
        & > #log-nodes { display: none; }
        &.-several > #log-nodes { display: block; }
        & > #log-empty { height: 1fr; content-align: center middle; text-align: center; color: $quiet; }
        & > LogView { display: none; height: 1fr; }
        &.-filled {
            & > #log-empty { display: none; }
            & > LogView, & > #log-tools { display: block; }
        }
        &.-filtering > #log-filter { display: block; }
    }
    """

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self.level = LEVELS[0]
        self.text = ""
        self.paused = False
        self._cleared_at = 0.0
        self._shown_count = self._total_count = 0
        self._state: NodeState | None = None
        self._frozen: NodeState | None = None

    def compose(self) -> ComposeResult:
        yield TabStrip({"": ""}, id="log-nodes")
        yield SteadyStatic("no node yet", id="log-head", classes="log-line")
        yield SteadyStatic(id="log-tools", classes="log-line")
        yield Input(placeholder="only lines with this text; Enter keeps it, Esc ends it", id="log-filter")
        yield Static(
            Content.assemble(
                ("Nothing is running yet\n\n", "bold $foreground"),
                "Press ",
                ("r", "bold $accent"),
                " to run your node; what it logs and prints appears here.\n",
                ("o", "bold $accent"),
                " sets its parameters and remaps.",
            ),
            id="log-empty",
        )
        yield LogView(id="log-view")

    def show_nodes(self, states: Mapping[Path, NodeState], shown: Path | None) -> None:
        """Show a tab for each node that has a log, if there are several; [ and ], or a click, choose another."""
        self.set_class(len(states) > 1, "-several")
        strip = self.query_one(TabStrip)
        with self.prevent(TabStrip.Turned):
            strip.labels = {str(path): f"{_mark(state)} {state.file}" for path, state in states.items()} or {"": ""}
            strip.active = str(shown or "")
        strip.refresh()

    def action_step(self, by: int) -> None:
        """Show the log of the next node, or with a negative `by` of the previous one."""
        if self.has_class("-several"):
            self.query_one(TabStrip).action_step(by)

    @on(TabStrip.Turned)
    def _tab_turned(self, message: TabStrip.Turned) -> None:
        message.stop()
        if message.tab:
            self.post_message(messages.NodeChosen(Path(message.tab)))

    def show(self, state: NodeState, domain: int, own: Sequence[Path], key: str = "r") -> None:
        """Show a node and its log. `own`: files whose lines in tracebacks can be clicked; `key` stops the node."""
        self.add_class("-filled")
        if self._state is not None and state.since > self._state.since and state.phase is Phase.STARTING:
            self.paused = False
        if self._state is not None and state.file != self._state.file:
            self._frozen = None
        self._state = state
        self.query_one(LogView).own = own
        head = Content.assemble(*_head(state), (f"   domain {domain}", "$quiet"))
        if state.alive:
            head = Content.assemble(head, (f"   {key}", "bold $accent"), (" stops it", "$quiet"))
        self.query_one("#log-head", Static).update(head)
        if not self.paused:
            self._show()

    # --- filters ---

    def next_level(self) -> None:
        """Raise the lowest level that is shown; after the highest, start over."""
        self.level = LEVELS[(LEVELS.index(self.level) + 1) % len(LEVELS)]
        self._show()

    def pause(self) -> None:
        """Pause or resume."""
        self.paused = not self.paused
        self._show()
        if not self.paused:
            self.query_one(LogView).scroll_end(animate=False)

    def clear(self) -> None:
        """Hide all lines so far."""
        self._cleared_at = time.time()
        self._show()

    def filter(self) -> None:
        """Ask for a text that lines must contain."""
        self.add_class("-filtering")
        self.query_one(Input).focus()

    @on(LogView.Followed)
    def _show_following(self) -> None:
        self._show_tools()

    @on(Input.Changed, "#log-filter")
    def _filtered(self, event: Input.Changed) -> None:
        event.stop()
        self.text = event.value
        self._show()

    @on(Input.Submitted, "#log-filter")
    def _keep(self, event: Input.Submitted) -> None:
        event.stop()
        self.query_one(LogView).focus()
        self.set_class(bool(self.text), "-filtering")

    def action_end_filter(self) -> None:
        """Show all lines again."""
        self.query_one(Input).value = ""
        self.remove_class("-filtering")
        self.query_one(LogView).focus()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Enable `end_filter` only while there is a filter."""
        return self.has_class("-filtering") if action == "end_filter" else True

    @property
    def error_location(self) -> tuple[Path, int] | None:
        """File and line in the learner's own code where the last traceback points; None without one."""
        lines = [loglines.parse_line(line) for line in self._state.lines] if self._state else []
        return loglines.last_own_location(lines, self.query_one(LogView).own)

    def _show(self) -> None:
        state = self._state
        if state is None:
            return
        if self.paused:
            state = self._frozen = self._frozen or state
        else:
            self._frozen = None
        parsed = [loglines.parse_line(line) for line in state.lines]
        lines = loglines.matching_lines(parsed, self.level, self.text, self._cleared_at)
        head: list[Row] = []
        if state.command:
            head.append(((" $       ", "quiet"), (state.command, "name")))
        if state.dropped:
            head.append(((f"({state.dropped} lines of a flood are not shown)", "quiet"),))
        tail: Row = ()
        if state.phase is Phase.ENDED:
            mark, kind = ("!", "error") if state.failed else ("■", "quiet")
            at = time.strftime("%H:%M:%S", time.localtime(state.ended_at))
            tail = ((f" {mark}      {at}  ", kind), (f"{state.file}: {state.note}", kind))
        self._shown_count, self._total_count = len(lines), len(parsed)
        self.query_one(LogView).show_log(lines, head, tail)
        self._show_tools()

    def _show_tools(self) -> None:
        self.query_one("#log-tools", Static).update(self._tools(self._shown_count, self._total_count))

    def _tools(self, shown: int, total: int) -> Content:
        following = "following" if self.query_one(LogView).following else "scrolled up: End follows"
        level = "all levels" if self.level is LEVELS[0] else f"{self.level.name} and above"
        parts: list[Content | str | tuple[str, str]] = []
        for key, name, text in (
            ("m", "level", level),
            ("/", "filter", f"'{self.text}'" if self.text else "filter"),
            ("Space", "pause", "paused: go on" if self.paused else following),
            ("C", "clear", "clear"),
        ):
            on = (name == "pause" and self.paused) or (name == "filter" and self.text)
            link = Content.from_markup(f"[@click=screen.do('{name}')]$text[/]", text=text)
            parts += [(key, "bold $accent"), " ", link.stylize("bold $warn") if on else link, "   "]
        if shown != total:
            parts.append((f"{shown} of {total} lines", "$warn"))
        return Content.assemble(*parts)


def _mark(state: NodeState) -> str:
    if state.alive:
        return "●" if state.phase is Phase.RUNNING else "◐"
    return "!" if state.failed else "■"


def _head(state: NodeState) -> list[tuple[str, str]]:
    if state.phase is Phase.RUNNING:
        return [("● running  ", "bold $good"), (state.file, "bold")]
    if state.phase is Phase.ENDED:
        colour = "$bad" if state.failed else "$quiet"
        return [
            ("! ended  " if state.failed else "■ ended  ", f"bold {colour}"),
            (state.file, "bold"),
            (f"  {state.note}", colour),
        ]
    return [(f"◐ {state.phase.value}  ", "bold $warn"), (state.file, "bold")]
