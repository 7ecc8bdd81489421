"""Log lines and templates are read quickly, however long they are."""

from __future__ import annotations

import ast
import itertools
import re
import time

import pytest

from checks.i1_2.reading import labelled, parse_log
from checks.i1_2.templates import match_literals, match_template
from tutor.judge.trace import LogRecord

LONG = 2000
UNITS = ["1", "1.", "1,", "1'", "1:", "1:00:", "a", "a1", "_", " ", "last", "last_ ", "#", "-", "@", "Hello World: 1 "]


@pytest.mark.parametrize("unit", UNITS)
def test_a_long_line_is_read_quickly(unit: str) -> None:
    started_at = time.process_time()
    for text in ((unit * LONG)[:LONG], ("last" + "_" * 900 + " " * 900 + unit)[:LONG] + 'x: "Hello World: 1"'):
        parse_log(LogRecord(20, "node", text, 0.0, 0.0), 1)
        list(labelled(text))
    assert time.process_time() - started_at < 0.5


@pytest.mark.parametrize("text", ["9" * LONG, "1e" + "9" * 1000, "1," + "9" * 1000, "-" + "9" * 400 + ".5"])
def test_an_endless_number_is_ignored(text: str) -> None:
    numbers = parse_log(LogRecord(20, "node", text, 0.0, 0.0), 1).numbers
    assert [int(value) for number in numbers for value in number.values] in ([], [1])


def test_a_template_of_many_parts_is_matched_quickly() -> None:
    template = ast.parse("f'" + "{a} " * 50 + "x'", mode="eval").body
    started_at = time.process_time()
    assert match_template(template, "1 " * 1000) is None
    assert time.process_time() - started_at < 0.5


def test_a_template_matches_like_a_non_greedy_regex() -> None:
    texts = ["", "a", "b", "ab"]
    messages = ["".join(each) for n in range(6) for each in itertools.product("ab", repeat=n)]
    for between in (each for n in (1, 2, 3, 4) for each in itertools.product(texts, repeat=n)):
        pattern = re.compile("(.*?)".join(between), re.DOTALL)
        for message in messages:
            found = pattern.fullmatch(message)
            assert match_literals(between, message) == (list(found.groups()) if found else None)
