"""The terminal page: several terminals, each with the learner's own shell, and a tab for each."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from rich.cells import cell_len, set_cell_size
from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Horizontal, Vertical
from textual.content import Content
from textual.widget import Widget
from textual.widgets import Static

from tutor.errors import ProcessError
from tutor.session.shell import ShellCommand
from tutor.terminal_text import strip_controls
from tutor.tui import messages
from tutor.tui.terminal.foreground import describe_foreground
from tutor.tui.terminal.view import TerminalView
from tutor.tui.widgets.strip import TabStrip

MAX_TERMINALS = 9
"""One for each digit."""

MIN_NAME_WIDTH, MAX_NAME_WIDTH = 4, 24
"""How much of a program's name is shown in its tab, in cells."""

TAB_EXTRA_WIDTH = 3
"""How much wider a tab is than its label, with the gap to the next one, in cells."""

LOOK_INTERVAL_S = 0.5
"""How often the tabs are brought up to date with what runs in the terminals."""


class TerminalPane(Vertical):
    """Keys go to the terminal shown while it has the focus. While the tabs have it, single keys switch terminals."""

    DEFAULT_CSS = Path(__file__).with_name("pane.tcss").read_text(encoding="utf-8")
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "focus_terminal", "Type", key_display="Enter"),
        Binding("plus", "new", "New", key_display="+"),
        Binding("minus", "close", "Close", key_display="-"),
        *(Binding(str(number), f"show({number})", show=False) for number in range(1, MAX_TERMINALS + 1)),
    ]

    def __init__(self, make_shell: Callable[[], tuple[ShellCommand, Path]], id: str | None = None) -> None:
        """`make_shell` is called in a thread; it may take a moment, and raise OSError, ValueError or LookupError."""
        super().__init__(id=id)
        self._make_shell = make_shell
        self._terminals: dict[int, TerminalView] = {}
        self._pending: list[str] | None = []
        """Lines to type once the page is there; None once it is."""
        self._shutting_down = False
        self._hint_text = ""
        self._tabs_width = 0

    def compose(self) -> ComposeResult:
        with Horizontal(id="terminal-line"):
            yield TabStrip({"": ""}, id="terminal-tabs")
            yield Static(id="terminal-hint", markup=False)
        yield Container(id="terminal-screens")
        yield Static(_EMPTY_TEXT, id="terminal-empty")

    def on_mount(self) -> None:
        self.set_interval(LOOK_INTERVAL_S, self._look)
        self.action_new()
        lines, self._pending = self._pending or [], None
        for line in lines:
            self.run_line(line)

    def focus_content(self) -> None:
        """Focus the terminal shown; the first one takes the focus when it is there."""
        if self._pending is None:
            self.action_focus_terminal()

    # --- the terminals ---

    @property
    def shown(self) -> TerminalView | None:
        """The terminal shown."""
        return self._terminals.get(self._number)

    @property
    def _number(self) -> int:
        active = self.query_one("#terminal-tabs", TabStrip).active
        return int(active) if active else 0

    @property
    def busy(self) -> bool:
        """Whether a program runs in one of the terminals."""
        return any(terminal.busy for terminal in self._terminals.values())

    def action_new(self) -> None:
        """Open another terminal, and show it."""
        number = next((number for number in range(1, MAX_TERMINALS + 1) if number not in self._terminals), None)
        if number is None:
            self.post_message(messages.ErrorOccurred(f"There are {MAX_TERMINALS} terminals: close one of them first."))
            return
        terminal = TerminalView(id=f"terminal-{number}")
        self._terminals[number] = terminal
        self.query_one("#terminal-screens", Container).mount(terminal)
        self.remove_class("-none")
        self._look(show=number)
        work: Callable[[], Any] = partial(self._run, number, terminal)
        self.run_worker(work, group="terminal")
        self.call_after_refresh(self.action_focus_terminal)

    async def _run(self, number: int, terminal: TerminalView) -> None:
        try:
            shell, folder = await asyncio.to_thread(self._prepare)
            await terminal.run(shell, folder)
        except (OSError, ValueError, LookupError, ProcessError) as error:
            self.post_message(messages.ErrorOccurred(f"No terminal can be opened: {error}"))
        finally:
            self._forget(number, terminal)

    def _prepare(self) -> tuple[ShellCommand, Path]:
        """Do, in a thread, what takes long: load the emulator, and find out what the shell needs."""
        from tutor.tui.terminal import emulator

        emulator.warm_up()
        return self._make_shell()

    def _forget(self, number: int, terminal: TerminalView) -> None:
        """Remove a terminal that has ended, and show the one before it."""
        if self._terminals.pop(number, None) is None or not self.is_attached or self._shutting_down:
            return
        focused = terminal.has_focus
        terminal.remove()
        left = [other for other in self._terminals if other < number] or list(self._terminals)
        self.set_class(not left, "-none")
        self._look(show=left[-1] if left else 0)
        if focused and left:
            self.action_focus_terminal()
        elif focused:
            self.query_one(TabStrip).focus()

    def action_close(self) -> None:
        """Close the terminal shown, with everything that runs in it."""
        if self.shown is not None:
            self.shown.close()

    def close_all(self) -> None:
        """Close all terminals; the workers of the group "terminal" end once nothing of them is left."""
        self._shutting_down = True
        for terminal in self._terminals.values():
            terminal.close()

    def run_line(self, line: str) -> None:
        """Type a command and Enter into a terminal that is at its prompt: the one shown, another, or a new one."""
        if self._pending is not None:
            self._pending.append(line)
            return
        free = [number for number in (self._number, *self._terminals) if number in self._terminals]
        number = next((number for number in free if self._terminals[number].free), None)
        if number is None:
            self.action_new()
            if self.shown is None or not self.shown.free:
                return
        else:
            self._look(show=number)
        terminal = self.shown
        assert terminal is not None
        typing: Callable[[], Any] = partial(terminal.type_line, strip_controls(line))
        terminal.run_worker(typing, group="typing")
        self.call_after_refresh(self.action_focus_terminal)

    # --- what is shown ---

    def action_focus_terminal(self) -> None:
        """Give the keys to the terminal shown, or open one if there is none."""
        if self.shown is None:
            self.action_new()
        elif isinstance(self.parent, Widget) and self.parent.display:  # the learner may be on another page already
            self.shown.focus(scroll_visible=False)

    def action_show(self, number: int) -> None:
        """Show the terminal with this number, and give it the keys."""
        if number in self._terminals:
            self._look(show=number)
            self.action_focus_terminal()

    def _look(self, show: int | None = None) -> None:
        """Bring the tabs up to date, and show this terminal, if given."""
        tabs = self.query_one("#terminal-tabs", TabStrip)
        labels = {str(number): self._label(number) for number in sorted(self._terminals)} or {"": ""}
        if labels != tabs.labels:
            tabs.labels = labels
            self._tabs_width = sum(cell_len(label) + TAB_EXTRA_WIDTH for label in labels.values()) + 1
            tabs.styles.width = self._tabs_width
        if show is not None:
            tabs.active = str(show or "")
            for number, terminal in self._terminals.items():
                terminal.set_class(number == show, "-shown")
            tabs.refresh()
        self._hint()

    def _label(self, number: int) -> str:
        """Return the number and what runs there, shortened so that all tabs have room."""
        program = self._terminals[number].program
        name = describe_foreground(program.foreground) if program is not None else ""
        room = self.size.width // len(self._terminals) - len("1 ") - TAB_EXTRA_WIDTH
        room = min(MAX_NAME_WIDTH, max(MIN_NAME_WIDTH, room))
        return f"{number} {name if cell_len(name) <= room else set_cell_size(name, room - 1) + '…'}"

    @on(TabStrip.Turned)
    def _turned(self, message: TabStrip.Turned) -> None:
        message.stop()
        self._look(show=self._number)

    @on(TerminalView.Scrolled)
    def _scrolled(self, message: TerminalView.Scrolled) -> None:
        message.stop()
        self._hint()

    @on(TerminalView.Left)
    def _left(self, message: TerminalView.Left) -> None:
        message.stop()
        self.query_one(TabStrip).focus()

    def on_resize(self, event: events.Resize) -> None:
        """Fit the tabs and the hint into the new width."""
        self._look()

    def on_descendant_focus(self, event: events.DescendantFocus) -> None:
        """Say which keys there are now."""
        self._hint()

    def on_descendant_blur(self, event: events.DescendantBlur) -> None:
        """Say which keys there are now."""
        self._hint()

    def _hint(self) -> None:
        """Say which keys there are, in as many words as there is room for beside the tabs."""
        terminal = self.shown
        if terminal is None:
            texts: tuple[str, ...] = ()
        elif below := terminal.rows_below:
            texts = (f"{below} more rows below · Shift+PgDn, or any key", f"{below} rows below")
        elif terminal.has_focus:
            texts = (
                "Ctrl+] or an F key leaves · Shift+PgUp scrolls back",
                "Ctrl+] or an F key leaves",
                "Ctrl+] leaves",
            )
        else:
            texts = ("Enter types · 1-9 shows · + new · - close", "Enter types · 1-9 shows", "Enter types")
        room = self.size.width - self._tabs_width - 2
        text = next((text for text in texts if cell_len(text) <= room), "")
        if text != self._hint_text:
            self._hint_text = text
            self.query_one("#terminal-hint", Static).update(text, layout=False)


_EMPTY_TEXT = Content.assemble(
    ("No terminal is open.\n\n", "bold $foreground"),
    ("Enter", "bold $accent"),
    " opens one: your own shell, in which ",
    ("ros2 topic list", "$code-type"),
    " works, with or without an installed ROS 2.",
)
