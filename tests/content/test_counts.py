"""Counting exercises: those of the course, and those beyond it."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from tutor.content import Counts


@dataclass(frozen=True)
class Exercise:
    id: str
    beyond: bool = False


COURSE = (Exercise("i1.1"), Exercise("i1.2"), Exercise("b1.1", True), Exercise("b1.2", True))


@pytest.mark.parametrize(
    ("passed", "text", "course_done", "all_done"),
    [
        ("", "0 of 2 passed", False, False),
        ("i1.1", "1 of 2 passed", False, False),
        ("i1.1 i1.2", "2 of 2 passed, 0 of 2 beyond", True, False),
        ("b1.1", "0 of 2 passed, 1 of 2 beyond", False, False),
        ("i1.1 i1.2 b1.1 b1.2", "2 of 2 passed, 2 of 2 beyond", True, True),
    ],
)
def test_what_goes_beyond_the_course_is_counted_apart(
    passed: str, text: str, course_done: bool, all_done: bool
) -> None:
    counts = Counts.of(COURSE, passed.split())
    assert (str(counts), counts.course_done, counts.all_done) == (text, course_done, all_done)


def test_a_course_without_more_does_not_mention_it() -> None:
    assert str(Counts.of(COURSE[:2], ["i1.1", "i1.2"])) == "2 of 2 passed"
    assert Counts.of(COURSE[:2], []).text("exercises") == "0 of 2 exercises passed"


def test_where_all_goes_beyond_it_is_the_course() -> None:
    assert Counts.of(COURSE[2:], ["b1.1"]) == Counts(1, 2)
