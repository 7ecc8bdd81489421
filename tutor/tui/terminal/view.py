"""One terminal: draws the emulator's screen, and sends keys, pastes and the mouse wheel to the program."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.binding import Binding, BindingType
from textual.geometry import Region
from textual.message import Message
from textual.selection import Selection
from textual.strip import Strip
from textual.timer import Timer
from textual.widget import Widget

from tutor.process.terminal_program import TerminalProgram
from tutor.session.shell import ShellCommand
from tutor.tui import commands
from tutor.tui.terminal.keys import key_bytes, paste_bytes, wheel_bytes
from tutor.tui.terminal.styled_rows import styled_row

if TYPE_CHECKING:
    from pathlib import Path

    from tutor.tui.terminal.emulator import Emulator

LEAVE_KEY = "ctrl+right_square_bracket"
"""The key that takes the focus away; it and the app's F keys are all that a program does not get."""

FLOOD_INTERVAL_S, TYPING_INTERVAL_S = 1 / 15, 1 / 60
"""Time between two paints while output arrives all the time: in general, and just after a key."""

TYPING_S = 0.3
PROMPT_S = 10.0
"""How long to wait for a shell's prompt before a command is typed all the same."""

_APP_KEYS = {LEAVE_KEY} | {key for command in commands.all_commands() for key in command.keys if key[1:].isdecimal()}
_WHEEL_ROWS = 3
_CLEAR_LINE = b"\x05\x15"
"""Ctrl+E, Ctrl+U: both bash and zsh then keep the line where Ctrl+Y finds it."""


class TerminalView(Widget, can_focus=True):
    """A shell on a terminal of its own. `run` starts it and returns once it is gone."""

    DEFAULT_CSS = """
    TerminalView { height: 1fr; background: $surface; color: $foreground; }
    """
    COMPONENT_CLASSES: ClassVar[set[str]] = {"terminal--cursor", "terminal--away"}
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(LEAVE_KEY, "leave", "Leave", key_display="Ctrl+]"),
        *commands.panel_bindings(
            commands.PAGE_LESSON, commands.PAGE_CODE, commands.CHECK, commands.PAGE_LIVE, commands.HELP, shown_key=1
        ),
    ]

    class Changed(Message):
        """The viewport has been scrolled."""

    class Left(Message):
        """The learner pressed the key that leaves the terminal."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.program: TerminalProgram | None = None
        self._emulator: Emulator | None = None
        self._laid_out, self._output, self._ended = asyncio.Event(), asyncio.Event(), asyncio.Event()
        self._texts: list[str] = []
        self._strips: list[Strip] = []
        self._base = Style()
        self._cursor: tuple[int, int] | None = None
        self._timer: Timer | None = None
        self._painted_at = self._typed_at = 0.0
        self._line_begun = False

    # --- the program ---

    async def run(self, shell: ShellCommand, folder: Path) -> str:
        """Run the shell until it or the terminal ends. Return how it failed, or "". Raises ProcessError."""
        from tutor.tui.terminal.emulator import Emulator

        await self._laid_out.wait()
        self._emulator = Emulator(self._cells, self._reply)
        self.program = await TerminalProgram.start(
            shell.argv,
            env=shell.env,
            cwd=folder,
            size=self._cells,
            on_output=self._receive,
            on_exit=self._ended.set,
        )
        try:
            self._fit()
            await self._ended.wait()
        finally:
            await self.program.end()
        return ""

    def close(self) -> None:
        """Close the terminal; `run` then ends the program."""
        self._ended.set()

    @property
    def busy(self) -> bool:
        """Whether something other than the shell runs in the foreground."""
        return (
            self.program is not None
            and self.program.exit is None
            and self.program.foreground not in (0, self.program.pid)
        )

    @property
    def free(self) -> bool:
        """Whether a command can be typed: the shell is at its prompt, or about to show its first one."""
        if self._ended.is_set():
            return False
        return self.program is None or self.program.reads_keys or not self._output.is_set()

    async def type_line(self, line: str) -> None:
        """Type a command and Enter, as soon as there is a prompt; what was typed on that line is taken back."""
        try:
            async with asyncio.timeout(PROMPT_S):
                while self.program is None or not self.program.reads_keys:
                    self._output.clear()
                    await self._output.wait()
        except TimeoutError:
            if self.program is None:
                return
        assert self.program is not None
        self._type((_CLEAR_LINE if self._line_begun else b"") + line.encode("utf-8", "replace") + b"\r")
        self._line_begun = False

    def _receive(self, data: bytes) -> None:
        if self._emulator is not None:
            self._emulator.feed(data)
            self._output.set()
            self._schedule_paint()

    def _reply(self, data: bytes) -> None:
        if self.program is not None:
            self.program.write(data)

    def _type(self, data: bytes) -> None:
        if self.program is None or self._emulator is None or not data:
            return
        self._line_begun = not data.endswith((b"\r", b"\x03", b"\x04"))
        if self._emulator.rows_below:
            self._scroll(None)
        self._typed_at = time.monotonic()
        self.program.write(data)

    # --- keys, pastes, and the mouse ---

    def check_consume_key(self, key: str, character: str | None = None) -> bool:
        """Return whether the program gets a key: all but the app's F keys and the one that leaves the terminal."""
        return key not in _APP_KEYS

    async def _on_key(self, event: events.Key) -> None:
        if not self.check_consume_key(event.key, event.character):
            return
        event.stop()
        event.prevent_default()
        page = max(1, self._cells[1] - 1)
        if self.text_selection is not None:
            selected = self.screen.get_selected_text()
            self.screen.clear_selection()
            if selected and event.key in ("ctrl+c", "ctrl+shift+c"):
                self.app.copy_to_clipboard(selected)
                return
        match event.key:
            case "shift+pageup":
                self._scroll(-page)
            case "shift+pagedown":
                self._scroll(page)
            case _ if self._emulator is not None:
                application = self._emulator.modes.application_cursor
                self._type(key_bytes(event.key, event.character, application_cursor=application))

    async def _on_paste(self, event: events.Paste) -> None:
        event.stop()
        event.prevent_default()
        if self._emulator is not None:
            self._type(paste_bytes(event.text, bracketed=self._emulator.modes.bracketed_paste))

    def _on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._turn_wheel(event, down=False)

    def _on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._turn_wheel(event, down=True)

    def _turn_wheel(self, event: events.MouseEvent, *, down: bool) -> None:
        event.stop()
        if self._emulator is None:
            return
        modes = self._emulator.modes
        if modes.mouse:
            self._type(wheel_bytes(down, event.x, event.y))
        elif modes.alternate_screen:  # nothing to scroll back to: less and vim move by the cursor keys
            key = key_bytes("down" if down else "up", None, application_cursor=modes.application_cursor)
            self._type(key * _WHEEL_ROWS)
        else:
            self._scroll(_WHEEL_ROWS if down else -_WHEEL_ROWS)

    def action_leave(self) -> None:
        """Give the keys back to the app."""
        self.post_message(self.Left())

    @property
    def rows_below(self) -> int:
        """How far the learner has scrolled back, in rows."""
        return 0 if self._emulator is None else self._emulator.rows_below

    def _scroll(self, rows: int | None) -> None:
        if self._emulator is not None:
            self._emulator.scroll(rows)
            self._paint()
            self.post_message(self.Changed())

    # --- the screen ---

    @property
    def _cells(self) -> tuple[int, int]:
        return self.size.width, self.size.height

    def on_resize(self) -> None:
        """Give the terminal the size of the widget."""
        if all(self._cells):
            self._laid_out.set()
            self._fit()

    def _fit(self) -> None:
        if self._emulator is not None and self._emulator.size != self._cells and all(self._cells):
            self._emulator.resize(self._cells)
            if self.program is not None:
                self.program.resize(self._cells)
            self._paint()

    def on_show(self) -> None:
        """Catch up with what was written while the terminal was not shown."""
        self._paint()

    def _schedule_paint(self) -> None:
        if self._timer is not None or not self.is_on_screen:
            return
        now = time.monotonic()
        interval = TYPING_INTERVAL_S if now - self._typed_at < TYPING_S else FLOOD_INTERVAL_S
        if (wait := self._painted_at + interval - now) <= 0:
            self._paint()
        else:
            self._timer = self.set_timer(wait, self._paint)

    def _paint(self) -> None:
        """Take the screen over from the emulator, and repaint the rows that differ."""
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
        self._painted_at = time.monotonic()
        if self._emulator is None:
            return
        texts, cursor, base = self._emulator.rows(), self._emulator.cursor, self.rich_style
        width = self._emulator.size[0]
        old = self._texts if base == self._base and self._strips and self._strips[0].cell_length == width else []
        changed = {y for y, text in enumerate(texts) if y >= len(old) or old[y] != text}
        self._strips = [
            styled_row(text, width, base) if y in changed else self._strips[y] for y, text in enumerate(texts)
        ]
        if cursor != self._cursor:
            changed |= {place[1] for place in (cursor, self._cursor) if place is not None}
        self._texts, self._cursor, self._base = texts, cursor, base
        if changed:
            first, last = min(changed), max(changed)
            self.refresh(Region(0, first, self.size.width, last - first + 1))

    def notify_style_update(self) -> None:
        """Follow the theme."""
        super().notify_style_update()
        if self._emulator is not None and self.rich_style != self._base:
            self._paint()

    @property
    def plain(self) -> str:
        """The text on the screen."""
        return "\n".join(strip.text.rstrip() for strip in self._strips)

    def render_line(self, y: int) -> Strip:
        """Render one row."""
        if y >= len(self._strips):
            return Strip.blank(self.size.width, self.rich_style)
        strip = self._strips[y]
        if (selection := self.text_selection) is not None and (span := selection.get_span(y)) is not None:
            start, end = span[0], strip.cell_length if span[1] == -1 else span[1]
            strip = _restyle(strip, start, end, self.screen.get_component_rich_style("screen--selection"))
        if self._cursor is not None and self._cursor[1] == y:
            x = self._cursor[0]
            width = 2 if len(strip.crop(x, x + 2).text) == 1 else 1
            kind = "terminal--cursor" if self.has_focus else "terminal--away"
            strip = _restyle(strip, x, x + width, self.get_component_rich_style(kind) + Style(reverse=False))
        return strip.adjust_cell_length(self.size.width, self._base).apply_offsets(0, y)

    def get_selection(self, selection: Selection) -> tuple[str, str] | None:
        """The selected text, for the clipboard."""
        return selection.extract(self.plain), "\n"

    def selection_updated(self, selection: Selection | None) -> None:
        """Repaint with the new selection."""
        self.refresh()


def _restyle(strip: Strip, start: int, end: int, style: Style) -> Strip:
    """Return the strip with its cells from `start` to before `end` in another style."""
    before, chosen, after = (strip.crop(a, b) for a, b in ((0, start), (start, end), (end, None)))
    restyled = Strip(Segment.apply_style(list(chosen), post_style=style), chosen.cell_length)
    return Strip.join([before, restyled, after])
