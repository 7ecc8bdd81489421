"""Markdown as plain text: what search shows, and what is read aloud."""

from __future__ import annotations

import re

import pytest

from tutor.content import load_course
from tutor.content.plain_text import plain_lines, without_markup


@pytest.mark.parametrize(
    ("markdown", "text"),
    [
        ("**QoS.** A plain `depth` of 10", "QoS. A plain depth of 10"),
        ("the number is a *period* in seconds", "the number is a period in seconds"),
        ("**`//` rounds down.** `2**63 - 1`, 2 * 3 * 4", "// rounds down. 2**63 - 1, 2 * 3 * 4"),
        ("[the *guide*](https://docs.ros.org/x) and <https://ros.org>", "the guide and https://ros.org"),
        ("in `**kwargs` and *two words*", "in **kwargs and two words"),
    ],
)
def test_inline_markup_is_left_out(markdown: str, text: str) -> None:
    assert without_markup(markdown) == text


def test_lines_keep_their_numbers_and_code_stays_as_it_is() -> None:
    markdown = (
        "## Background\n\n> **Note.** a\n- one `**two`\n1. three\n```python\n# **not** bold\n```\n"
        "| a | `b` |\n|---|:--|\n**a long\nemphasis**\n"
    )
    assert dict(plain_lines(markdown)) == {
        0: "Background",
        2: "Note. a",
        3: "one **two",
        4: "1. three",
        6: "# **not** bold",
        8: "a · b",
        10: "a long",
        11: "emphasis",
    }


def test_no_line_of_the_lessons_keeps_a_mark() -> None:
    for lesson in load_course().lessons:
        prose = re.sub(r"^```.*?^```$", lambda block: re.sub(r"[^\n]", "", block[0]), lesson.body, flags=re.M | re.S)
        left = [text for _, text in plain_lines(prose) if re.search(r"\*\*\D|`|^#|\]\(|\|", text)]
        assert left == [], lesson.id
