"""The step for a slip that keeps Python from parsing a file is the corrected line."""

from __future__ import annotations

import pytest

from tutor.judge.rewriting.syntax import make_readable
from tutor.judge.step_parsing import apply_step

_VALID = """\
import time


class Stats:
    def __init__(self):
        self.count = 0
        self.make("chatter", self.callback, 10)

    def make(self, name, callback, depth):
        self.last = [
            dict(name=name, depth=depth),
            dict(name="other", depth=10),
        ]

    def callback(self, message):
        if self.count == 3:
            self.count = 0
        self.count += 1
        print(f"{self.count}: {message}", time.time())
"""


@pytest.mark.parametrize(
    ("line", "slipped"),
    [
        ('        self.make("chatter", self.callback, 10)', '        self.make("chatter", self.callback, 10'),
        ('        self.make("chatter", self.callback, 10)', '        self.make("chatter", self.callback, 10))'),
        ('        self.make("chatter", self.callback, 10)', '        self.make("chatter, self.callback, 10)'),
        ('        self.make("chatter", self.callback, 10)', '        self.make("chatter" self.callback, 10)'),
        ("            dict(name=name, depth=depth),", "            dict(name=name, depth=depth,"),
        ("            dict(name=name, depth=depth),", "            dict(name=name, depth=depth)"),
        ("    def callback(self, message):", "    def callback(self, message)"),
        ("    def callback(self, message):", "    dfe callback(self, message):"),
        ("        if self.count == 3:", "        if self.count = 3:"),
        ("        if self.count == 3:", "       if self.count == 3:"),
        ("            self.count = 0\n        self", "        self.count = 0\n        self"),
        ("        self.count += 1", "      self.count += 1"),
        ("        self.count += 1", "\t self.count += 1"),
    ],
)
def test_the_step_for_a_slip_is_the_corrected_line(line: str, slipped: str) -> None:
    broken = _VALID.replace(line, slipped, 1)
    assert broken != _VALID

    step = make_readable(broken)

    assert step is not None
    assert apply_step(step, {"stats.py": broken})["stats.py"] == _VALID


def test_two_slips_are_corrected_in_one_step() -> None:
    broken = _VALID.replace("message):", "message)").replace("10)\n\n    def", "10\n\n    def")

    step = make_readable(broken)

    assert step is not None
    assert apply_step(step, {"stats.py": broken})["stats.py"] == _VALID


def test_there_is_no_step_for_a_valid_file_or_if_no_small_change_helps() -> None:
    assert make_readable(_VALID) is None
    assert make_readable("") is None
    assert make_readable("this is a text and no program at all\n" * 5) is None


def test_a_null_character_is_removed() -> None:
    assert make_readable("import os\n\0print(os)\n") == "line 2 becomes: print(os)"
