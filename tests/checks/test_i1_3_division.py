"""I1.3: verdicts on a division by zero, and on what comes after it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i1_3_calculator_service import CHECK
from tests.checks.builders import CRASH, CRASHED, NODE_UP, assert_passed, called, exited, judge_of, log, trace
from tests.checks.calculator import ALL, SERVING, assert_failed
from tutor.exercise.survives_bad_call import CallsAroundBad, find_complaints
from tutor.judge.trace import CallAnswer, LogRecord, Trace

judge_division = judge_of(CHECK, "divide-by-zero")

DIVISIONS_AFTER_ZERO = ((18, 3), (-9, 0), (0, 0), (35, 5))
ERRORS = Path(__file__).with_name("i1_3_errors.txt").read_text("utf-8").splitlines()
NO_ERRORS = ["", *Path(__file__).with_name("i1_3_ordinary_messages.txt").read_text("utf-8").splitlines()]
INCOMING = "Incoming request: a={} b={}"
ORDINARY = (log("calculator ready"), log(INCOMING.format(84, 7)), log("84 / 7 = 12"))


def after_zero(*results: int | None) -> tuple[CallAnswer, ...]:
    """The answers to the calls after a division by zero."""
    return tuple(called("/divide", a, b, result) for (a, b), result in zip(DIVISIONS_AFTER_ZERO, results, strict=False))


def division(
    *logged: LogRecord,
    by_zero: int | None = 0,
    after: tuple[CallAnswer, ...] = after_zero(6, 0, 0, 7),
    seen: Trace = SERVING,
    before: int | None = 12,
) -> CallsAroundBad:
    good = called("/divide", 84, 7, before)
    return CallsAroundBad(
        seen,
        good,
        (good, good),
        None if before is None else called("/divide", 10, 0, by_zero),
        after,
        ORDINARY,
        logged,
    )


COMPLAINT = log("division by zero", 40)
ENDED = trace(exit=exited(0, after_s=9.0))


@pytest.mark.parametrize("text", ERRORS)
def test_an_error_is_understood_in_many_languages(text: str) -> None:
    assert_passed(judge_division(division(log(INCOMING.format(10, 0)), log(text))))
    assert_passed(judge_division(division(log(text.upper()))))


@pytest.mark.parametrize("level", [30, 40, 50])
def test_a_warning_needs_no_particular_words(level: int) -> None:
    assert_passed(judge_division(division(log("b = 0", level))))


@pytest.mark.parametrize("text", NO_ERRORS)
def test_an_ordinary_message_is_not_an_error(text: str) -> None:
    assert_failed(judge_division(division(log(text))), "not logged")


@given(st.sampled_from(ERRORS), st.sampled_from([10, 20, 30, 40]), st.integers(), st.integers())
def test_what_is_also_logged_for_a_valid_call_is_not_a_complaint(text: str, level: int, usual: int, now: int) -> None:
    assert find_complaints([log(f"{text} {usual}", level)], [log(f"{text} {now}", level)]) == []


@given(st.sampled_from(ERRORS), st.lists(st.sampled_from(ORDINARY)))
def test_an_error_is_found_among_other_messages(text: str, around: list[LogRecord]) -> None:
    assert find_complaints(ORDINARY, [*around, log(text), *around]) == [log(text)]


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (CallsAroundBad(CRASHED), "unhandled exception", "84"),
        (CallsAroundBad(trace(graph=NODE_UP)), "no answer", "84"),
        (division(before=None), "no answer", "84"),
        (division(by_zero=None), "no answer", "10 ÷ 0"),
        (division(by_zero=None, seen=trace(err=CRASH, exit=exited(1))), "unhandled exception", "line 12"),
        (division(), "not logged", "nothing that the node logs"),
        (division(before=588), "not logged", "84 ÷ 7 is answered 588"),
        (division(seen=trace(graph=ALL, out="error: division by zero")), "printed, not logged", "print()"),
        (division(COMPLAINT, after=after_zero(None)), "no answer", "after a division by zero"),
        (division(COMPLAINT, after=after_zero(6, None)), "no answer", "-9 ÷ 0"),
        (division(COMPLAINT, after=after_zero(6, 0, None)), "no answer", "0 ÷ 0"),
        (division(COMPLAINT, after=after_zero(6, 0, 0, None)), "no answer", "35 ÷ 5"),
        (division(COMPLAINT, after=after_zero(0, 0, 0, 7)), "wrong answer", "18 ÷ 3 was answered 0"),
        (division(COMPLAINT, after=after_zero(6, 0, 0, 0)), "wrong answer", "35 ÷ 5 was answered 0"),
        (division(COMPLAINT, after=after_zero(None), seen=ENDED), "exit at once", "18 ÷ 3"),
        (division(after=after_zero(None), seen=ENDED), "exit at once", "18 ÷ 3"),
        (division(seen=ENDED), "exit at once", ""),
    ],
)
def test_division_fails(seen: CallsAroundBad, cause: str, word: str) -> None:
    assert_failed(judge_division(seen), cause, word)


def test_an_error_that_good_divisions_log_as_well_is_quoted() -> None:
    seen = replace(division(log("error", 40)), ordinary=(log("error", 40),))
    assert_failed(judge_division(seen), "the same message for every call", "in the same words", ": error")


@pytest.mark.parametrize("results", [(6, 0, 0, 7), (6, -1, 99, 7)])
def test_any_answer_to_a_division_by_zero_passes(results: tuple[int, ...]) -> None:
    assert_passed(judge_division(division(COMPLAINT, after=after_zero(*results))))


def test_wrong_division_in_general_is_not_judged_here() -> None:
    assert_passed(judge_division(division(COMPLAINT, before=13, after=after_zero(7, 0, 0, 8))))
