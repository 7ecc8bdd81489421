"""Log lines are read quickly, however long they are."""

from __future__ import annotations

import time

import pytest

from checks.i1_2_message_statistics.log_lines import labelled, parse_log
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
