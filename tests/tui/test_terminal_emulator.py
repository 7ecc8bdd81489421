"""The emulator, and what Textual draws of it: text and colours, whatever a program writes."""

from __future__ import annotations

import os
import random
import re
import resource

from rich.cells import cell_len
from rich.style import Style

from tutor.terminal_text import strip_controls
from tutor.tui.terminal import emulator
from tutor.tui.terminal.emulator import Emulator
from tutor.tui.terminal.keys import PASTE_END, PASTE_START, key_bytes, paste_bytes
from tutor.tui.terminal.styled_rows import styled_row

SGR = re.compile(r"\x1b\[[\d;:]*m")

ATTACKS = (
    b"\x1b]52;c;aGVsbG8=\x07",  # the clipboard
    b"\x1b]0;title\x07\x1b]2;title\x1b\\",
    b"\x07" * 1000,
    b"\x1b[21t\x1b[8;1;1t\x1b[2t",  # report the title, resize and iconify the window
    b"\x1b]9;notify\x07\x1b]777;notify;a;b\x07",
    b"\x1b]8;;http://example.org\x1b\\link\x1b]8;;\x1b\\",
    b"\x1bPq#0;2;0;0;0#0!10~-\x1b\\",  # an image
    b"\x1b_Gf=24,s=1,v=1;AAAA\x1b\\",
    b"\x1b]4;1;rgb:ff/ff/ff\x07\x1b]10;#fff\x07",
    b"\x9b31m\x9d52;c;aGk=\x9c",  # the 8-bit forms
    "\u202eright to left\u2066\u200b".encode(),
    b"\x1b[999999999;99999999H\x1b[2147483647b\x1b[5i\x1bc",
)


def open_emulator(columns: int = 40, rows: int = 5) -> tuple[Emulator, list[bytes]]:
    replies: list[bytes] = []
    return Emulator((columns, rows), replies.append), replies


def cursor(terminal: Emulator) -> tuple[int, int] | None:
    return terminal.cursor


def text(terminal: Emulator) -> list[str]:
    return [styled_row(row, terminal.size[0], Style()).text.rstrip() for row in terminal.rows()]


def test_nothing_but_text_and_colours_leaves_the_emulator() -> None:
    for attack in ATTACKS:
        terminal, replies = open_emulator()
        terminal.feed(b"before" + attack + b"after")
        for row in terminal.rows():
            assert "\x1b" not in SGR.sub("", row), attack
            strip = styled_row(row, 40, Style())
            assert strip.cell_length == cell_len(strip.text) == 40
            assert strip.text.isprintable(), attack
        assert replies == [], attack


def test_random_bytes_neither_crash_it_nor_get_out() -> None:
    random.seed(45)
    terminal, _ = open_emulator()
    for _ in range(300):
        terminal.feed(random.randbytes(200) + b"\x1b" + random.choice(b"[]P_^XNO#()").to_bytes() + os.urandom(20))
        if random.random() < 0.2:
            terminal.resize((random.randint(1, 80), random.randint(1, 30)))
        rows = terminal.rows()
        assert len(rows) == terminal.size[1]
        drawn = [styled_row(row, terminal.size[0], Style()).text for row in rows]
        assert [strip_controls(row) for row in drawn] == drawn
        assert not any(c < " " or "\x7f" <= c <= "\x9f" for row in drawn for c in row)


def test_questions_are_answered_to_the_program_only() -> None:
    terminal, replies = open_emulator()
    terminal.feed(b"\x1b[c\x1b[6n\x1b[5n")
    assert b"".join(replies).startswith(b"\x1b[?62")
    assert b"\x1b[1;1R" in replies
    assert not any(text(terminal))


def test_the_screen_has_colours_wide_characters_a_cursor_and_a_history() -> None:
    terminal, _ = open_emulator()
    terminal.feed("a\x1b[1;31mred\x1b[0m\x1b[48;2;1;2;3mb\x1b[0m\r\n漢字 e\u0301\x1b[3;4H".encode())
    first, second, *_ = [styled_row(row, 40, Style()) for row in terminal.rows()]
    styles = {segment.text.strip(): segment.style for segment in first}
    red, blue = styles["red"], styles["b"]
    assert str(red) == "bold color(1)"
    assert str(blue) == "on #010203"
    assert second.text.rstrip() == "漢字 e\u0301"
    assert cursor(terminal) == (3, 2)
    terminal.feed(b"\x1b[?25l")
    assert cursor(terminal) is None

    terminal.feed(b"\x1b[?25h\x1b[2J\x1b[H" + b"".join(b"%d\r\n" % number for number in range(100)))
    assert text(terminal) == ["96", "97", "98", "99", ""]
    terminal.scroll(-10)
    assert text(terminal)[0] == "86"
    assert terminal.rows_below == 10
    assert cursor(terminal) is None
    terminal.feed(b"more\r\n")  # what is read stays where it is
    assert text(terminal)[0] == "86"
    terminal.scroll(None)
    assert text(terminal)[-2] == "more"


def test_a_full_screen_program_leaves_the_screen_as_it_was() -> None:
    terminal, _ = open_emulator()
    terminal.feed(b"$ vim\r\n\x1b[?1049h\x1b[2J\x1b[Hfull screen\x1b[?1h\x1b[?2004h\x1b[?1000h\x1b[?1006h")
    assert text(terminal)[0] == "full screen"
    modes = terminal.modes
    assert (modes.alternate_screen, modes.application_cursor, modes.bracketed_paste, modes.mouse) == (True,) * 4
    terminal.feed(b"\x1b[?1049l\x1b[?1l\x1b[?2004l\x1b[?1000l")
    assert text(terminal)[0] == "$ vim"
    modes = terminal.modes
    assert (modes.alternate_screen, modes.application_cursor, modes.bracketed_paste, modes.mouse) == (False,) * 4


def test_a_resize_wraps_long_lines_again() -> None:
    terminal, _ = open_emulator(10, 4)
    terminal.feed(b"0123456789abcde")
    assert text(terminal)[:2] == ["0123456789", "abcde"]
    terminal.resize((20, 4))
    assert text(terminal)[0] == "0123456789abcde"


def test_pictures_made_of_several_characters_keep_the_columns_in_line() -> None:
    for shown in ("👍🏽", "👨\u200d👩\u200d👧", "❤\ufe0f", "🇩🇪", "e\u0301", "漢"):
        terminal, _ = open_emulator()
        terminal.feed(shown.encode())
        assert terminal.cursor is not None
        column = terminal.cursor[0]
        terminal.feed(b"|")
        strip = styled_row(terminal.rows()[0], 40, Style())
        assert cell_len(strip.text.partition("|")[0]) == column, shown
        assert strip.cell_length == 40


def test_history_and_memory_are_bounded() -> None:
    terminal, _ = open_emulator(120, 36)
    terminal.feed(b"warm up\r\n" * 3 * emulator.HISTORY_ROWS)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    terminal.feed(b"y" * 110 + b"\r\n" * 20)
    for _ in range(100):
        terminal.feed(b"".join(b"\x1b[38;5;%dmline %d\r\n" % (number % 256, number) for number in range(1000)))
        terminal.feed(b"\x1b]52;c;" + b"A" * 100_000)
        terminal.feed(("\x1b\\e" + "\u0301" * 10_000).encode())
    terminal.scroll(-1_000_000)
    assert terminal.rows_below <= 1.2 * emulator.HISTORY_ROWS
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 50_000  # KB


def test_keys_are_sent_as_xterm_sends_them() -> None:
    sent = {
        ("a", "a"): b"a",
        ("ä", "ä"): "ä".encode(),
        ("plus", "+"): b"+",
        ("enter", "\r"): b"\r",
        ("backspace", "\x7f"): b"\x7f",
        ("ctrl+c", "\x03"): b"\x03",
        ("ctrl+shift+x", None): b"\x18",
        ("escape", "\x1b"): b"\x1b",
        ("tab", "\t"): b"\t",
        ("shift+tab", None): b"\x1b[Z",
        ("up", None): b"\x1b[A",
        ("shift+left", None): b"\x1b[1;2D",
        ("ctrl+delete", None): b"\x1b[3;5~",
        ("pageup", None): b"\x1b[5~",
        ("alt+b", "b"): b"\x1bb",
        ("alt+shift+b", "B"): b"\x1bB",
        ("alt+enter", None): b"\x1b\r",
        ("ctrl+backslash", "\x1c"): b"\x1c",
        ("f13", None): b"",
        ("ignore", "\x1b[200x"): b"",
    }
    for (key, character), expected in sent.items():
        assert key_bytes(key, character) == expected, key
    assert key_bytes("up", None, application_cursor=True) == b"\x1bOA"
    assert key_bytes("ctrl+up", None, application_cursor=True) == b"\x1b[1;5A"


def test_a_paste_is_text_and_cannot_end_early() -> None:
    hostile = "one\r\ntwo\x1b[201~\x03rm\x9b201~\n"
    assert paste_bytes(hostile, bracketed=True) == PASTE_START + b"one\rtwo[201~rm201~\r" + PASTE_END
    assert paste_bytes(hostile, bracketed=False) == b"one\rtwo[201~rm201~\r"
