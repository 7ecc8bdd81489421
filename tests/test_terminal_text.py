"""Foreign text cannot control the terminal, whether printed, in a report or next to a log line."""

from __future__ import annotations

import pytest

from tutor.terminal_text import escape_controls, printable, strip_ansi, strip_controls

CONTROL_TEXT = "a\x1b]0;owned\x07b\x1b[2Jc\x9b2Jd\u202ee\u2066f\0g"


def test_control_characters_are_shown_as_escapes() -> None:
    assert escape_controls(CONTROL_TEXT) == "a\\x1b]0;owned\\x07b\\x1b[2Jc\\x9b2Jd\\u202ee\\u2066f\\x00g"
    assert printable("\ud800\t|\r\n") == "\N{REPLACEMENT CHARACTER}   |\n"
    assert escape_controls("ä 温度\t\N{SNOWMAN}\n") == "ä 温度\t\N{SNOWMAN}\n"


def test_with_colors_only_color_sequences_are_kept() -> None:
    assert escape_controls("\x1b[1;32mgreen\x1b[0m", colors=True) == "\x1b[1;32mgreen\x1b[0m"
    assert escape_controls(CONTROL_TEXT, colors=True) == escape_controls(CONTROL_TEXT)


def test_escape_sequences_are_stripped_from_program_output() -> None:
    assert strip_ansi("\x1b[31mred\x1b[0m \x1b]0;title\x07\x9bx\r", tab=8) == "red \N{REPLACEMENT CHARACTER}x"


@pytest.mark.parametrize("text", [CONTROL_TEXT, "a\tb\nc", "温\u202e"])
def test_stripping_controls_keeps_the_cell_width(text: str) -> None:
    from rich.cells import cell_len

    assert cell_len(strip_controls(text)) == cell_len(text)
    assert strip_controls(text).isprintable()
