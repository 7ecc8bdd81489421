"""I2.1: verdicts on bad rates that a parameterized publisher is asked for, alone or together with good values."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from checks.i2_1_parameterized_publisher import BAD_RATES, CHECK
from tests.checks.builders import (
    CRASHED,
    answer,
    assert_passed,
    assert_skipped,
    early_judge_of,
    judge_of,
    rate,
    refused,
    sample,
)
from tests.checks.parameterized_publisher import (
    BROKEN_LATER,
    PREFIX,
    RATE,
    RUNNING,
    TOPIC,
    WRONG_TYPE,
    assert_failed,
    runtime_changes,
)
from tutor.exercise.bad_values import AtomicRequests, BadValues
from tutor.exercise.rate_at_run_time import RateChanges
from tutor.judge.trace import SetAnswer, Trace

VALIDATION_HZ = 3.0
WITHOUT_RATE_BEFORE = runtime_changes(before=None)

judge_validation, judge_validation_so_far = judge_of(CHECK, "validation"), early_judge_of(CHECK, "validation")
judge_atomic = judge_of(CHECK, "atomic")

REFUSED = tuple((refused({RATE: bad}), 1.0) for bad in BAD_RATES)


def bad_rates(
    *rejected: tuple[SetAnswer, Any],
    hz: float | None = 1.0,
    base_hz: float = 1.0,
    seen: Trace = RUNNING,
    **more: Any,
) -> BadValues:
    """What is observed of a node at `base_hz` that is asked for bad rates, and then publishes at `hz`."""
    rejected = rejected or tuple((answer, base_hz) for answer, _ in REFUSED)
    measured = rate(hz) if hz else None
    return BadValues(seen, base_hz, base_hz, rejected, rate=measured, messages=4, **more)


@pytest.mark.parametrize(
    "found",
    [
        bad_rates(),
        bad_rates(hz=1.15),
        bad_rates(base_hz=4.0, hz=4.1),
        bad_rates(base_hz=2.0, hz=2.0),
        # An old timer, which still runs, is judged by `timer`.
        bad_rates(base_hz=3.0, hz=4.2, rate_before=rate(3.6)),
    ],
)
def test_validation_passes(found: BadValues) -> None:
    assert_passed(judge_validation(found, WITHOUT_RATE_BEFORE))


@pytest.mark.parametrize(
    "reason",
    [
        "publish_rate: {bad} doesn't comply with floating point range",
        "Wrong parameter type or value: I need a positive float",
        "publish_rate cannot be set to this",
        "no rate that has not been declared a positive one",
        "my callback: Callback returned an invalid type",
    ],
)
def test_a_custom_reason_may_contain_wording_from_rclpy(reason: str) -> None:
    refusing = bad_rates(*((refused({RATE: bad}, reason.format(bad=bad)), 1.0) for bad in BAD_RATES))
    assert_passed(judge_validation(refusing, WITHOUT_RATE_BEFORE))


def test_validation_is_not_judged_where_a_good_rate_is_rejected() -> None:
    verdict = judge_validation(bad_rates(set_good=refused({RATE: 3.0}, "not now")), WITHOUT_RATE_BEFORE)
    assert_skipped(verdict, "not now")
    assert_skipped(verdict, "see `timer`")


def test_answers_that_are_right_so_far_pass() -> None:
    assert_passed(judge_validation_so_far(bad_rates(hz=None)))
    assert_passed(judge_validation_so_far(BadValues(RUNNING, rejected=REFUSED[:1])))


def bad_rates_with(which: SetAnswer, value: Any = 1.0) -> BadValues:
    return bad_rates(REFUSED[0], (which, value))


BAD = {RATE: -1.0}


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (BadValues(CRASHED), "unhandled exception", ""),
        (BadValues(RUNNING), "no spin", ""),
        (bad_rates_with(answer(BAD)), "no validation", "-1.0 was accepted"),
        (bad_rates((answer({RATE: 0.0}), 0.0)), "no validation", "0.0 was accepted"),
        (bad_rates_with(refused(BAD, "")), "no reason given", "-1.0"),
        (bad_rates_with(refused(BAD, "  ")), "no reason given", "-1.0"),
        (bad_rates_with(answer(BAD, answered=False)), "no answer", "no answer"),
        (bad_rates_with(refused(BAD, "Callback returned an invalid type")), "callback returns None", ""),
        (bad_rates_with(refused(BAD, WRONG_TYPE)), "wrong parameter type", ""),
        (
            bad_rates_with(refused(BAD, "Invalid access to undeclared parameter(s): publish_rate")),
            "parameter not declared",
            "",
        ),
        (
            bad_rates_with(
                refused(BAD, "parameter list cannot be empty, this might be due to pre_set_parameters_callback")
            ),
            "value dropped before it is set",
            "pre-set",
        ),
        (
            bad_rates_with(refused(BAD, "Trying to set a read-only parameter: publish_rate")),
            "read-only parameter",
            "publish_rate",
        ),
        (bad_rates_with(refused(BAD), -1.0), "value changed all the same", "-1.0 now"),
        (bad_rates_with(refused(BAD), None), "value changed all the same", "None"),
        (bad_rates(hz=3.0), "value changed all the same", "3.00 Hz"),
        (bad_rates(base_hz=4.0, hz=1.0), "value changed all the same", "1.00 Hz"),
        (bad_rates(hz=None), "value changed all the same", "after the rejection"),
        (bad_rates(hz=None, seen=BROKEN_LATER), "unhandled exception", "line 12"),
    ],
)
def test_validation_fails(found: BadValues, cause: str, word: str) -> None:
    assert_failed(judge_validation(found, WITHOUT_RATE_BEFORE), cause, word)


BEFORE = ("Hello", 1.0)


def atomic_requests(**changes: Any) -> AtomicRequests:
    facts: dict[str, Any] = {
        "trace": RUNNING,
        "answers": (refused({PREFIX: "a", RATE: -1.0}), refused({RATE: -1.0, PREFIX: "b"})),
        "before": BEFORE,
        "values": (BEFORE, BEFORE),
        "rate": rate(1.0),
        **changes,
    }
    return AtomicRequests(messages=4, **facts)


def test_a_rate_that_was_never_right_only_has_to_stay() -> None:
    # A node that never reads publish_rate fails other criteria.
    fixed = runtime_changes(before=rate(2.05))
    assert_passed(judge_validation(bad_rates(hz=2.0), fixed))
    assert_passed(judge_atomic(atomic_requests(rate=rate(2.0)), fixed, RateChanges(RUNNING)))
    assert_failed(judge_validation(bad_rates(hz=5.0), fixed), "value changed all the same")
    assert_failed(judge_validation(bad_rates(hz=None), fixed), "value changed all the same")
    fallen = bad_rates(base_hz=VALIDATION_HZ, hz=1.0, rate_before=rate(VALIDATION_HZ))
    assert_failed(judge_validation(fallen, runtime_changes()), "value changed all the same")


def test_atomic_passes() -> None:
    for found in (atomic_requests(), atomic_requests(rate=rate(2.1), base_hz=2.0)):
        assert_passed(judge_atomic(found, WITHOUT_RATE_BEFORE, RateChanges(RUNNING)))


ACCEPTED, NO_ANSWER = answer({RATE: -1.0}), answer({RATE: -1.0}, answered=False)
NO = refused({RATE: -1.0})


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (AtomicRequests(CRASHED), "unhandled exception", ""),
        (AtomicRequests(RUNNING), "no spin", ""),
        (atomic_requests(answers=(NO, NO_ANSWER)), "no answer", "no answer"),
        (atomic_requests(answers=(NO, ACCEPTED)), "no validation", "accepted"),
        (atomic_requests(answers=(ACCEPTED, NO)), "no validation", "accepted"),
        (atomic_requests(values=(("a", 1.0), BEFORE)), "value changed all the same", "('a', 1.0)"),
        (atomic_requests(values=(BEFORE, ("Hello", -1.0))), "value changed all the same", "-1.0"),
        (atomic_requests(shown=sample(TOPIC, "Partial1 3", 1005.0)), "value changed all the same", "Partial1 3"),
        (atomic_requests(rate=None), "value changed all the same", "the messages stop"),
        (atomic_requests(rate=rate(5.0)), "value changed all the same", "5.00 Hz"),
    ],
)
def test_atomic_fails(found: AtomicRequests, cause: str, word: str) -> None:
    assert_failed(judge_atomic(found, WITHOUT_RATE_BEFORE, RateChanges(RUNNING)), cause, word)


@pytest.mark.parametrize(
    ("prefix_set", "rate_set", "see"),
    [(True, False, "see `timer`"), (False, False, "see `runtime-params`"), (True, True, "not judged")],
)
def test_atomic_is_not_judged_where_good_values_are_rejected(prefix_set: bool, rate_set: bool, see: str) -> None:
    good = {PREFIX: "Whole1", RATE: 3.0}
    found = atomic_requests(set_good=refused(good, WRONG_TYPE))
    switched = runtime_changes(set_value=answer({PREFIX: "a"}, successful=prefix_set))
    retimed = RateChanges(RUNNING, ((answer({RATE: 10.0}, successful=rate_set), None, 0),))
    verdict = judge_atomic(found, switched, retimed)
    assert_skipped(verdict, WRONG_TYPE)
    assert_skipped(verdict, see)
    assert_passed(judge_atomic(replace(found, set_good=answer(good)), switched, retimed))
