"""I1.2: what is read from log messages: numbers, quotations, summaries."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i1_2_message_statistics.log_lines import parse_log, values
from checks.i1_2_message_statistics.logged_summaries import find_summaries
from tests.checks.statistics_nodes import RIGHT, node
from tests.checks.statistics_trials import logged, slowly, with_log


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("10", 10), ("4.93", 4.93), ("4,93", 4.93), ("4,93", 93), ("1,234.5", 1234.5), ("1.234,5", 1234.5),
        ("1'234", 1234), ("1_234", 1234), ("-4.93", -4.93), ("1e1", 10), ("4.9e+00", 4.9), ("10,4.93", 10),
        ("10,4.93", 4.93), ("1.2.3", 2), ("007", 7), ("1,234", 1.234), ("1,234", 1234),
    ],
)  # fmt: skip
def test_possible_values_of_a_number(written: str, meant: float) -> None:
    assert meant in list(values(written))


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("10 of “Hello World: 12” at 15:04:05 on 2026-05-05", ["10"]),
        ("\x1b[31m7\x1b[0m apples, -3 pears, 2-3 plums, \uff15", ["7", "-3", "2", "3", "5"]),
        ("合計10件", ["10"]),
        ("no number at all", []),
        ("10'5 and 1_2", ["10", "5", "1", "2"]),
        ("1,234.5 of 1.234,5", ["1,234.5", "1.234,5"]),
    ],
)
def test_which_parts_of_a_text_are_numbers(text: str, numbers: list[str]) -> None:
    assert [number.text for number in parse_log(logged(text), 1).numbers] == numbers


def test_a_list_without_spaces_is_several_numbers() -> None:
    numbers = parse_log(logged("20,4.95,5,Hello World: 0"), 1).numbers
    assert [number.values for number in numbers] == [(20,), (4.95,), (5,)]
    numbers = parse_log(logged("10,4,93,0"), 1).numbers
    assert [number.value for number in numbers] == [10, 4, 93, 0]
    assert 4.93 in numbers[1].values


@given(st.text(alphabet="0123456789.,'_-+eE \u2212\u2019\u202f\u00a0"))
def test_any_text_can_be_read(text: str) -> None:
    assert all(number.values for number in parse_log(logged(text), 1).numbers)


def test_messages_with_the_same_wording_are_of_the_same_kind() -> None:
    texts = "got   Hello World: 9, 1 of 3 ###", "got Hello World: 10,  12.5 of -4 #####"
    one, other = (parse_log(logged(text), 1) for text in texts)
    assert one.kind == other.kind
    assert (one.quoted, other.quoted) == ((9,), (10,))


def test_an_alarm_next_to_a_summary_is_not_part_of_the_next_one() -> None:
    beside = node(heard=lambda node: [(30, "by the way: 3")] if node.count == 10 else ())
    summaries = find_summaries(slowly(beside).steady)
    assert [(summary.messages, len(summary.lines)) for summary in summaries] == [(10, 1), (20, 1)]


def test_a_message_just_before_a_summary_is_due_is_not_part_of_it() -> None:
    trial = slowly(RIGHT).jump
    seen = with_log(trial, "1 lost in the last second", trial.sent[29].at - 0.01, 40)
    assert [summary.messages for summary in find_summaries(seen)] == [10, 20, 30]
