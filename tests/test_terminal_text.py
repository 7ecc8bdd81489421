"""Foreign text is text: on a terminal, in a report, beside a line of the log."""

from __future__ import annotations

import pytest

from tutor.terminal_text import escape_controls, printable, strip_ansi, strip_controls

STEERING = "a\x1b]0;owned\x07b\x1b[2Jc\x9b2Jd\u202ee\u2066f\0g"


def test_what_steers_a_terminal_is_shown_as_escapes() -> None:
    assert escape_controls(STEERING) == "a\\x1b]0;owned\\x07b\\x1b[2Jc\\x9b2Jd\\u202ee\\u2066f\\x00g"
    assert printable("\ud800\t|\r\n") == "\N{REPLACEMENT CHARACTER}   |\n"
    assert escape_controls("ä 温度\t\N{SNOWMAN}\n") == "ä 温度\t\N{SNOWMAN}\n"


def test_colours_come_through_where_they_are_wanted_and_nothing_else_does() -> None:
    assert escape_controls("\x1b[1;32mgreen\x1b[0m", colors=True) == "\x1b[1;32mgreen\x1b[0m"
    assert escape_controls(STEERING, colors=True) == escape_controls(STEERING)


def test_a_line_of_a_program_loses_its_sequences() -> None:
    assert strip_ansi("\x1b[31mred\x1b[0m \x1b]0;title\x07\x9bx\r", tab=8) == "red \N{REPLACEMENT CHARACTER}x"


@pytest.mark.parametrize("text", [STEERING, "a\tb\nc", "温\u202e"])
def test_what_is_drawn_takes_the_cells_that_it_was_measured_with(text: str) -> None:
    from rich.cells import cell_len

    assert cell_len(strip_controls(text)) == cell_len(text)
    assert strip_controls(text).isprintable()
