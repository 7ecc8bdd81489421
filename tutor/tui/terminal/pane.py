"""The terminal page: a prompt, a tab for each command that was run, and the output of the selected one."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Input, Static

from tutor.session.node import Node, NodeState
from tutor.session.shell import Shell
from tutor.terminal_text import strip_ansi
from tutor.tui import messages
from tutor.tui.terminal.completion import complete
from tutor.tui.terminal.history import History
from tutor.tui.terminal.output_view import OutputView, failed_by_itself
from tutor.tui.terminal.prompt import Prompt
from tutor.tui.widgets.strip import TabStrip

MAX_ENDED_JOBS = 8
"""Number of ended commands whose output is kept."""

LABEL_WIDTH = 26
"""Maximum length of the command in a tab's label, in characters."""


class TerminalPane(Vertical):
    """Runs each line in a separate process, so that a node, `topic echo` and `topic hz` can be watched at once."""

    DEFAULT_CSS = Path(__file__).with_name("pane.tcss").read_text(encoding="utf-8")
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+c", "interrupt", "Stop", key_display="Ctrl+C"),
        Binding("enter,tab", "prompt", "Prompt", show=False),
        Binding("left,ctrl+pageup", "turn(-1)", "Previous command", show=False),
        Binding("right,ctrl+pagedown", "turn(1)", "Next command", show=False),
    ]

    def __init__(self, make_shell: Callable[[], Shell], history: History, id: str | None = None) -> None:
        """`make_shell` is called in a thread; it may take a moment, and raise OSError or ValueError with a reason."""
        super().__init__(id=id)
        self._make_shell = make_shell
        self._shell: Shell | None = None
        self._history = history
        self._numbers = count(1)
        self._jobs: dict[str, Node] = {}
        self._pending_lines: list[str] = []
        self._error_tab: str | None = None  # the command below whose output an error is shown
        self._ready = False

    def compose(self) -> ComposeResult:
        with Horizontal(id="terminal-line"):
            yield Static("", id="terminal-place", markup=False)
            yield Static(" $ ", id="terminal-mark", markup=False)
            yield Prompt(self._history, id="terminal-prompt")
        yield Static(id="terminal-offers", markup=False)
        yield TabStrip({"": ""}, id="terminal-jobs")
        yield OutputView(id="terminal-output")
        yield Static(_EMPTY_TEXT, id="terminal-empty")

    def on_mount(self) -> None:
        self._ready = True
        self._start_worker(self._open)

    async def _open(self) -> None:
        try:
            self._shell = await asyncio.to_thread(self._make_shell)
        except (OSError, ValueError) as error:
            self.post_message(messages.ErrorOccurred(f"No command can be run: {error}"))
            return
        self._show_place()
        pending, self._pending_lines = self._pending_lines, []
        for line in pending:
            self.run_line(line)

    def focus_content(self) -> None:
        """Focus the prompt."""
        if self._ready:
            self.query_one(Prompt).focus(scroll_visible=False)
        else:
            self.call_after_refresh(self.focus_content)

    # --- running ---

    @on(Input.Submitted, "#terminal-prompt")
    def _typed(self, event: Input.Submitted) -> None:
        event.stop()
        line = event.value.strip()
        event.input.value = ""
        if line:
            self.run_line(line)

    def run_line(self, line: str) -> None:
        """Run a command as if it had been typed, or as soon as the shell is ready."""
        if self._shell is None:
            self._pending_lines.append(line)
            return
        self._history.add(line)
        self._show_offers("")
        self._show_error("")
        if line in ("clear", "exit"):
            self._clear()
            return
        match self._shell.run_builtin(line):
            case Shell() as changed:
                self._shell = changed
                self._show_place()
            case str() as error:
                self._show_error(error)
                self.add_class("-filled")
            case None:
                self._start(self._shell, line)

    def _start(self, shell: Shell, line: str) -> None:
        name = str(next(self._numbers))
        node = Node(shell.command(line), partial(self._job_changed, name))
        self._jobs[name] = node
        for old in [key for key, job in self._jobs.items() if not job.state.alive][:-MAX_ENDED_JOBS]:
            del self._jobs[old]
        self.add_class("-filled")
        self._show_jobs(select=name)
        self._start_worker(node.run)

    def _job_changed(self, name: str, state: NodeState) -> None:
        if name not in self._jobs or not self.is_attached:
            return
        self._show_jobs()
        if name == self._shown:
            self.query_one(OutputView).show_state(state)

    def action_interrupt(self) -> None:
        """Send Ctrl+C to the command shown if it is running, else to the running one that was started last."""
        shown = self._jobs.get(self._shown)
        alive = [job for job in self._jobs.values() if job.state.alive]
        job = shown if shown is not None and shown.state.alive else next(reversed(alive), None)
        if job is not None:
            job.stop()

    @property
    def running(self) -> list[Node]:
        """The commands that are still running."""
        return [job for job in self._jobs.values() if job.state.alive]

    def stop_all(self) -> None:
        """Stop all commands."""
        for job in self._jobs.values():
            job.stop()

    @property
    def typed_commands(self) -> list[str]:
        """All commands typed so far, oldest first."""
        return self._history.entries

    def _start_worker(self, work: Callable[[], Any]) -> None:
        self.run_worker(work, group="terminal")

    # --- what is shown ---

    @property
    def _shown(self) -> str:
        return self.query_one("#terminal-jobs", TabStrip).active

    def _show_jobs(self, select: str | None = None) -> None:
        strip = self.query_one("#terminal-jobs", TabStrip)
        strip.labels = {name: _label(name, job.state) for name, job in reversed(self._jobs.items())} or {"": ""}
        if select is not None and select != strip.active:
            strip.active = select

    @on(TabStrip.Turned)
    def _turned(self, message: TabStrip.Turned) -> None:
        message.stop()
        if message.tab != self._error_tab:
            self._show_error("")
        job = self._jobs.get(message.tab)
        self.query_one(OutputView).show_state(job.state if job else None, new=True)
        self.query_one("#terminal-jobs", TabStrip).refresh()

    @on(Prompt.Turned)
    def _turn_asked(self, message: Prompt.Turned) -> None:
        message.stop()
        self.action_turn(message.by)

    def _show_error(self, text: str) -> None:
        self._error_tab = self._shown if text else None
        self.query_one(OutputView).show_error(text)

    def action_turn(self, by: int) -> None:
        """Show the output of the next (1) or previous (-1) command."""
        if self._jobs:
            self.query_one("#terminal-jobs", TabStrip).action_step(by)

    def action_prompt(self) -> None:
        """Go back to the prompt."""
        self.focus_content()

    @on(Prompt.Interrupted)
    def _interrupted(self, message: Prompt.Interrupted) -> None:
        message.stop()
        prompt = self.query_one(Prompt)
        if prompt.value:
            prompt.value = ""
        else:
            self.action_interrupt()

    @on(Prompt.Left)
    def _left(self, message: Prompt.Left) -> None:
        message.stop()
        self.query_one(OutputView).focus()

    @on(Prompt.Cleared)
    def _clear_asked(self, message: Prompt.Cleared) -> None:
        message.stop()
        self._clear()

    def _clear(self) -> None:
        """Remove the commands that have ended."""
        self._show_error("")
        self._jobs = {name: job for name, job in self._jobs.items() if job.state.alive}
        names = list(self._jobs)
        self._show_jobs(select=names[-1] if names else "")
        self.query_one(OutputView).show_state(self._jobs[names[-1]].state if names else None, new=True)
        self.set_class(bool(names), "-filled")

    def _show_place(self) -> None:
        assert self._shell is not None
        self.query_one("#terminal-place", Static).update(self._shell.place)

    # --- completion ---

    @on(Prompt.Completed)
    def _complete_asked(self, message: Prompt.Completed) -> None:
        message.stop()
        if self._shell is not None:
            complete: Callable[[], Any] = self._complete
            self.run_worker(complete, group="terminal-completion", exclusive=True)

    async def _complete(self) -> None:
        prompt, shell = self.query_one(Prompt), self._shell
        if shell is None:
            return
        line, cursor = prompt.value, prompt.cursor_position
        found = await complete(line, cursor, shell.env, shell.cwd)
        if (prompt.value, prompt.cursor_position) != (line, cursor):
            return  # the line has been edited meanwhile
        prompt.value = found.line
        prompt.cursor_position = found.cursor
        self._show_offers("  ".join(strip_ansi(offer) for offer in found.offers))

    @on(Input.Changed, "#terminal-prompt")
    def _typing(self, event: Input.Changed) -> None:
        event.stop()
        self._show_offers("")

    def _show_offers(self, text: str) -> None:
        offers = self.query_one("#terminal-offers", Static)
        offers.update(text)
        offers.display = bool(text)


def _label(name: str, state: NodeState) -> str:
    command = strip_ansi(state.command).replace("\n", " ")
    short = command if len(command) <= LABEL_WIDTH else command[: LABEL_WIDTH - 1] + "…"
    mark = "●" if state.alive else ("!" if failed_by_itself(state) else "■")
    return f"{mark} {name} {short}"


_EMPTY_TEXT = Content.assemble(
    ("Your terminal\n\n", "bold $foreground"),
    "Type a command and press ",
    ("Enter", "bold $accent"),
    ": ",
    ("ros2 topic list", "$code-type"),
    " works here, with or without an installed ROS 2.\nIts output appears here. The next command runs beside it; ",
    ("Ctrl+C", "bold $accent"),
    " stops the one shown.\n",
    ("R", "bold $accent"),
    " offers the commands of the lesson; ",
    ("Tab", "bold $accent"),
    " completes; ",
    ("Esc", "bold $accent"),
    " leaves the prompt.",
)
