"""One terminal: its program, and the keys, pastes and turns of the mouse wheel that the program gets."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message

from tutor.process.terminal_program import TerminalProgram
from tutor.session.shell import ShellCommand
from tutor.tui import commands
from tutor.tui.terminal.keys import key_bytes, paste_bytes, wheel_bytes
from tutor.tui.terminal.screen_view import ScreenView

if TYPE_CHECKING:
    from pathlib import Path

LEAVE_KEY = "ctrl+right_square_bracket"
"""The key that takes the focus away; it and the app's F keys are all that a program does not get."""

PROMPT_S = 10.0
"""How long to wait for a shell's prompt before a command is typed all the same."""

_APP_KEYS = {LEAVE_KEY} | {key for command in commands.all_commands() for key in command.keys if key[1:].isdecimal()}
_WHEEL_ROWS = 3
_CLEAR_LINE = b"\x05\x15"
"""Ctrl+E, Ctrl+U: both bash and zsh then keep the line where Ctrl+Y finds it."""


class TerminalView(ScreenView, can_focus=True):
    """A shell on a terminal of its own. `run` starts it and returns once it is gone."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(LEAVE_KEY, "leave", "Leave", key_display="Ctrl+]"),
        *commands.panel_bindings(
            commands.PAGE_LESSON, commands.PAGE_CODE, commands.CHECK, commands.PAGE_LIVE, commands.HELP, shown_key=1
        ),
    ]

    class Left(Message):
        """The learner pressed the key that leaves the terminal."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.program: TerminalProgram | None = None
        self._laid_out, self._output, self._ended = asyncio.Event(), asyncio.Event(), asyncio.Event()
        self._line_begun = False

    # --- the program ---

    async def run(self, shell: ShellCommand, folder: Path) -> None:
        """Run the shell until it ends or the terminal is closed. Raises ProcessError."""
        from tutor.tui.terminal.emulator import Emulator

        await self._laid_out.wait()
        if self._ended.is_set():
            return
        self.emulator = Emulator(self._cells, self._reply)
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

    def close(self) -> None:
        """Close the terminal; `run` then ends the program."""
        self._ended.set()
        self._laid_out.set()  # it may never have been shown

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
        if self.emulator is not None:
            self.emulator.feed(data)
            self._output.set()
            self.schedule_paint()

    def _reply(self, data: bytes) -> None:
        if self.program is not None:
            self.program.write(data)

    def _type(self, data: bytes) -> None:
        if self.program is None or self.emulator is None or not data:
            return
        self._line_begun = not data.endswith((b"\r", b"\x03", b"\x04"))
        if self.emulator.rows_below:
            self.scroll_rows(None)
        self.typed_at = time.monotonic()
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
                self.scroll_rows(-page)
            case "shift+pagedown":
                self.scroll_rows(page)
            case _ if self.emulator is not None:
                application = self.emulator.modes.application_cursor
                self._type(key_bytes(event.key, event.character, application_cursor=application))

    async def _on_paste(self, event: events.Paste) -> None:
        event.stop()
        event.prevent_default()
        if self.emulator is not None:
            self._type(paste_bytes(event.text, bracketed=self.emulator.modes.bracketed_paste))

    def _on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._turn_wheel(event, down=False)

    def _on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._turn_wheel(event, down=True)

    def _turn_wheel(self, event: events.MouseEvent, *, down: bool) -> None:
        event.stop()
        if self.emulator is None:
            return
        modes = self.emulator.modes
        if modes.mouse:
            self._type(wheel_bytes(down, event.x, event.y))
        elif modes.alternate_screen:  # nothing to scroll back to: less and vim move by the cursor keys
            key = key_bytes("down" if down else "up", None, application_cursor=modes.application_cursor)
            self._type(key * _WHEEL_ROWS)
        else:
            self.scroll_rows(_WHEEL_ROWS if down else -_WHEEL_ROWS)

    def action_leave(self) -> None:
        """Give the keys back to the app."""
        self.post_message(self.Left())

    # --- the size ---

    @property
    def _cells(self) -> tuple[int, int]:
        return self.size.width, self.size.height

    def on_resize(self) -> None:
        """Give the terminal the size of the widget."""
        if all(self._cells):
            self._laid_out.set()
            self._fit()

    def _fit(self) -> None:
        if self.emulator is not None and self.emulator.size != self._cells and all(self._cells):
            self.emulator.resize(self._cells)
            if self.program is not None:
                self.program.resize(self._cells)
            self.paint()
