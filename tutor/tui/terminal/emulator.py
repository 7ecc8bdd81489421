"""The emulator of one terminal: Ghostty's, through pyghostty. What a program writes ends here, as rows of text.

Its effects on the world outside are callbacks, and only one is set: replies (to "which terminal are you?"), which go to
the program itself. Titles, bells, the clipboard, notifications and images reach nothing.

Import it late, and call `warm_up` in a thread: pyghostty reads its C declarations then, which takes half a second.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pyghostty.core import Terminal, check, ffi, init_sized, lib, read_buf, union_fn

HISTORY_ROWS, HISTORY_BYTES = 2000, 8 << 20
"""Bounds of what has left the screen, whichever is reached first."""

_ALTERNATE_SCREEN = 1
_PALETTE = re.compile(r"(?:\x1b\]4;[^\x1b]*\x1b\\)*")

# cffi cannot pass a union by value; pyghostty's `union_fn` takes a twin without one.
ffi.cdef("typedef struct { GhosttyTerminalScrollViewportTag tag; int64_t rows; uint64_t unused; } GhosttyScrollS;")
assert ffi.sizeof("GhosttyScrollS") == ffi.sizeof("GhosttyTerminalScrollViewport")


@dataclass(frozen=True, slots=True)
class Modes:
    """What the program has asked of the terminal that matters for keys, pastes and the mouse."""

    application_cursor: bool
    bracketed_paste: bool
    alternate_screen: bool
    mouse: bool


class Emulator:
    """The screen of one terminal and its history; the viewport shows the screen until it is scrolled."""

    def __init__(self, size: tuple[int, int], reply: Callable[[bytes], object]) -> None:
        """`size`: columns and rows. `reply` is called with what the terminal answers to the program."""
        self.size = size
        self._terminal = Terminal(cols=size[0], rows=size[1], scrollback=HISTORY_ROWS)
        self._handle = self._terminal._t[0]
        self._set(lib.GHOSTTY_TERMINAL_OPT_SCROLLBACK_MAX_BYTES, "size_t*", HISTORY_BYTES)
        self._set(lib.GHOSTTY_TERMINAL_OPT_KITTY_IMAGE_STORAGE_LIMIT, "uint64_t*", 0)
        self._terminal.on_reply(reply)

    def feed(self, data: bytes) -> None:
        """Take what the program has written."""
        self._terminal.feed(data)

    def resize(self, size: tuple[int, int]) -> None:
        """Change the size, in columns and rows; lines that were wrapped are wrapped again."""
        self.size = size
        self._terminal.resize(*size)

    def rows(self) -> list[str]:
        """Return the rows of the viewport: printable text, with SGR sequences (colours and the like) and no others."""
        columns, count = self.size
        selection = init_sized("GhosttySelection")
        selection.start = self._terminal.ref(0, 0, "viewport")[0]
        selection.end = self._terminal.ref(columns - 1, count - 1, "viewport")[0]
        options = init_sized("GhosttyTerminalSelectionFormatOptions")
        options.emit = lib.GHOSTTY_FORMATTER_FORMAT_VT
        options.unwrap, options.trim, options.selection = False, False, selection

        def fill(buffer: object, length: int, written: object) -> object:
            return lib.ghostty_terminal_selection_format_buf(self._handle, options[0], buffer, length, written)

        text: str = read_buf(fill)
        start = _PALETTE.match(text)
        rows = text[start.end() if start else 0 :].split("\r\n")
        return [*rows, *[""] * (count - len(rows))][:count]

    @property
    def cursor(self) -> tuple[int, int] | None:
        """The cursor's column and row in the viewport, from 0; None if it is hidden or out of view."""
        if not self._get("cursor_visible", "bool"):
            return None
        x, y = self._terminal.cursor
        y += self.rows_below
        return (x, y) if y < self.size[1] else None

    @property
    def rows_below(self) -> int:
        """The number of rows below the viewport: 0 unless it is scrolled."""
        bar = self._get("scrollbar", "GhosttyTerminalScrollbar")
        return max(0, int(bar.total) - int(bar.offset) - int(bar.len))

    def scroll(self, rows: int | None) -> None:
        """Move the viewport by so many rows, up if negative; None: to the end, where it follows the output again."""
        behaviour = ffi.new("GhosttyScrollS*")
        behaviour.tag = lib.GHOSTTY_SCROLL_VIEWPORT_BOTTOM if rows is None else lib.GHOSTTY_SCROLL_VIEWPORT_DELTA
        behaviour.rows = rows or 0
        union_fn("ghostty_terminal_scroll_viewport", "void(*)(GhosttyTerminal, GhosttyScrollS)")(
            self._handle, behaviour[0]
        )

    @property
    def modes(self) -> Modes:
        """The modes that the program has set."""
        return Modes(
            application_cursor=self._terminal.mode(1),
            bracketed_paste=self._terminal.mode(2004),
            alternate_screen=self._get("active_screen", "int") == _ALTERNATE_SCREEN,
            mouse=bool(self._get("mouse_tracking", "int")) and self._terminal.mode(1006),
        )

    def _get(self, name: str, kind: str) -> Any:
        return self._terminal.get(name, kind)

    def _set(self, option: int, kind: str, value: int) -> None:
        check(lib.ghostty_terminal_set(self._handle, option, ffi.new(kind, value)), "terminal_set")


def warm_up() -> None:
    """Use everything once: each declaration is compiled when it is first used."""
    emulator = Emulator((2, 2), lambda _: None)
    emulator.feed(b"\x1b[c")
    emulator.scroll(None)
    emulator.resize((3, 2))
    _ = emulator.rows(), emulator.cursor, emulator.rows_below, emulator.modes
