"""Wrapping between words and, in code, between names."""

from __future__ import annotations

import re

import pytest
from textual.content import Content

from tutor.tui.widgets.wrapped import wrap

CODE = 'self.timer = self.create_timer(1.0/self.get_parameter("publish_rate").value, self.publish_temperature)'


def rows(text: str, width: int, hang: int = 0) -> list[tuple[str, str]]:
    return [(row.plain, joint) for row, joint in wrap(Content(text), width, hang)]


@pytest.mark.parametrize("width", range(28, 110))
@pytest.mark.parametrize("text", [CODE, "    " + CODE, f"In line 18, write {CODE} there, and check again."])
def test_no_name_is_broken_no_row_is_too_wide_and_nothing_is_lost(text: str, width: int) -> None:
    names = set(re.findall(r"\w+", text))
    found = rows(text, width, hang=2)
    assert max(len(row) for row, _ in found) <= width
    assert {name for row, _ in found for name in re.findall(r"\w+", row)} == names
    indent = min(len(text) - len(text.lstrip()) + 2, width // 3)
    first, *rest = found
    assert first[0] + first[1] + "".join(row[indent:] + joint for row, joint in rest) == text + "\n"


def test_words_stay_together_and_code_is_broken_only_if_it_does_not_fit_into_a_row() -> None:
    assert rows("Give create_timer 1.0 / rate.", 20) == [("Give create_timer", " "), ("1.0 / rate.", "\n")]
    assert rows("call create_timer(1.0, self.tick) once", 22) == [
        ("call create_timer(1.0,", " "),
        ("self.tick) once", "\n"),
    ]
    assert rows("x = a_function(another_one(third))", 20)[0] == ("x = a_function(", "")
    assert rows("  " + "y" * 30, 20, hang=2)[1][0].startswith("    y"), "a name longer than a row is broken after all"
    assert rows("温度温度温度", 5) == [("温度", ""), ("温度", ""), ("温度", "\n")]
    assert rows("", 10) == [("", "\n")]
