"""I2.1: verdicts on fabricated answers of a parameterized publisher to changes while it runs."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i2_1_parameterized_publisher import CHECK
from tests.checks.builders import (
    CRASHED,
    answer,
    assert_passed,
    early_judge_of,
    judge_of,
    rate,
    refused,
    sample,
    samples,
    trace,
)
from tests.checks.parameterized_publisher import (
    AFTER_RESUME,
    BROKEN_LATER,
    DOWN_HZ,
    ENABLED,
    PUBLISHING,
    RATE,
    RUNNING,
    SILENT,
    TOPIC,
    UP_HZ,
    WRONG_TYPE,
    assert_failed,
    rate_changes,
    runtime_changes,
)
from tutor.exercise.rate_at_run_time import RateChanges
from tutor.exercise.run_time_changes import RunTimeChanges
from tutor.judge.trace import SetAnswer
from tutor.judge.verdict import Verdict

judge_runtime, judge_changes = judge_of(CHECK, "runtime-params"), early_judge_of(CHECK, "runtime-params")
judge_timer = judge_of(CHECK, "timer")

STOPPED_EARLY = runtime_changes(set_later=None, set_on=None, resumed=None, after_resume=(), rate=None)
"""What is observed if a change is refused or ignored: the check then asks for no more."""


def not_set(reason: str, answered: bool = True) -> SetAnswer:
    return answer({ENABLED: False}, reason, successful=False, answered=answered)


def judge_with_timer(seen: RunTimeChanges, timer: RateChanges | None = None) -> Verdict:
    return judge_runtime(seen, timer or rate_changes())


@pytest.mark.parametrize(
    "found",
    [
        runtime_changes(),
        runtime_changes(after_value=sample(TOPIC, "say Servus7", 1003.0)),
        runtime_changes(after_resume=samples(TOPIC, 1.0, data="Gruezi9: Hello World")),
        runtime_changes(rate=rate(2.1), base_hz=2.0),
        runtime_changes(before=rate(5.2), rate=rate(5.0)),  # already wrong: not because of the switch
    ],
)
def test_runtime_passes(found: RunTimeChanges) -> None:
    assert_passed(judge_with_timer(found))


def test_messages_due_while_disabled_must_not_be_sent_later() -> None:
    late = [sample(TOPIC, f"Gruezi9 {n}", 1008.0 + n / 100) for n in range(3)]
    seen = runtime_changes(trace=trace(*late, graph=PUBLISHING))
    assert_failed(judge_with_timer(seen), "messages held back", "3 messages at once")
    assert_passed(judge_with_timer(runtime_changes(trace=trace(*late[:2], graph=PUBLISHING))))
    assert_passed(judge_with_timer(seen, rate_changes(UP_HZ + 1.0, DOWN_HZ + 11.0)))
    fast = [sample(TOPIC, f"Gruezi9 {n}", 1008.0 + n / 10) for n in range(9)]
    assert_passed(
        judge_with_timer(runtime_changes(trace=trace(*fast, graph=PUBLISHING), before=rate(10.0), rate=rate(10.0)))
    )


def test_a_rate_change_does_not_start_a_disabled_node() -> None:
    seen = runtime_changes(sent_after_rate=samples(TOPIC, 10.0, count=3))
    assert_failed(judge_with_timer(seen), "restarted by another parameter", "3 messages")
    assert_passed(judge_with_timer(seen, rate_changes(UP_HZ + 1.0, DOWN_HZ + 11.0)))  # `timer` reports it


def test_a_timer_that_a_rate_change_also_leaves_behind_is_reported_once() -> None:
    twice = rate_changes(UP_HZ + 1.0, DOWN_HZ + 11.0)
    assert_passed(judge_with_timer(runtime_changes(rate=rate(2.0)), twice))
    assert_failed(judge_with_timer(runtime_changes(rate=None, after_resume=()), twice), "does not resume")
    assert_failed(
        judge_with_timer(runtime_changes(after_resume=samples(TOPIC, 1.0, data="Hello 5")), twice), "parameter ignored"
    )


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (RunTimeChanges(CRASHED), "unhandled exception", "to start with"),
        (RunTimeChanges(SILENT), "no spin", ""),
        (RunTimeChanges(RUNNING), "no spin", "no parameter call"),
        (runtime_changes(set_value=not_set("", answered=False)), "no answer", "no answer in 5 s"),
        (runtime_changes(set_off=not_set("", answered=False), trace=BROKEN_LATER), "unhandled exception", "line 12"),
        (runtime_changes(set_off=not_set("Callback returned an invalid type")), "callback returns None", ""),
        (runtime_changes(set_off=not_set(WRONG_TYPE)), "wrong parameter type", "is of type string, not boolean"),
        (runtime_changes(set_on=not_set("enabled has not been declared")), "parameter not declared", ""),
        (runtime_changes(set_on=not_set("no way")), "good value refused", "no way"),
        (runtime_changes(after_value=None), "parameter ignored", 'still read "Hello"'),
        (runtime_changes(sent_while_off=samples(TOPIC, 1.0, count=2)), "parameter ignored", "2 messages"),
        (runtime_changes(set_later=not_set("no way")), "good value refused", "no way"),
        (runtime_changes(set_later=not_set("", answered=False), set_on=None), "no answer", "no answer in 5 s"),
        (runtime_changes(after_resume=samples(TOPIC, 1.0, data="Hello 5")), "parameter ignored", '"Hello 5"'),
        (
            runtime_changes(after_resume=(*AFTER_RESUME, sample(TOPIC, "Servus7 8", 1012.0))),
            "parameter ignored",
            "Servus7 8",
        ),
        (
            runtime_changes(after_resume=samples(TOPIC, 1.0, data="HelloServus7Gruezi9")),
            "old value kept beside the new one",
            "HelloServus7Gruezi9",
        ),
        (runtime_changes(rate=rate(2.0)), "rate changed by another parameter", "2.00 Hz"),
        (runtime_changes(rate=rate(2.0), before=None), "rate changed by another parameter", "2.00 Hz"),
        (runtime_changes(rate=None, after_resume=()), "does not resume", "no message"),
        (runtime_changes(rate=None, after_resume=(), trace=BROKEN_LATER), "unhandled exception", "line 12"),
        (runtime_changes(resumed=None), "does not resume", ENABLED),
        (runtime_changes(resumed=None, trace=BROKEN_LATER), "unhandled exception", "line 12"),
    ],
)
def test_runtime_fails(found: RunTimeChanges, cause: str, word: str) -> None:
    assert_failed(judge_with_timer(found), cause, word)


@pytest.mark.parametrize(
    ("found", "cause"),
    [
        (replace(STOPPED_EARLY, set_value=not_set("no way"), after_value=None, set_off=None), "good value refused"),
        (replace(STOPPED_EARLY, after_value=None, set_off=None), "parameter ignored"),
        (replace(STOPPED_EARLY, set_off=not_set("no way")), "good value refused"),
        (replace(STOPPED_EARLY, sent_while_off=tuple(samples(TOPIC, 1.0, count=2))), "parameter ignored"),
        (runtime_changes(after_resume=samples(TOPIC, 1.0, data="Hello 5")), "parameter ignored"),
    ],
)
def test_a_change_without_effect_fails_whatever_follows(found: RunTimeChanges, cause: str) -> None:
    for verdict in (judge_changes(found), judge_with_timer(found), judge_with_timer(found, rate_changes(UP_HZ, None))):
        assert_failed(verdict, cause)


def test_a_changed_rate_is_judged_only_with_the_timer() -> None:
    assert_passed(judge_changes(runtime_changes(rate=rate(2.0))))
    assert_failed(judge_with_timer(runtime_changes(rate=rate(2.0))), "rate changed by another parameter")


@given(st.floats(0.81, 1.19), st.floats(0.81, 1.19))
def test_a_timer_within_20_percent_passes(up: float, down: float) -> None:
    assert_passed(judge_timer(rate_changes(UP_HZ * up, DOWN_HZ * down)))


@given(st.booleans(), st.floats(0.01, 0.79) | st.floats(1.21, 20))
def test_a_timer_off_by_more_than_20_percent_fails(first: bool, factor: float) -> None:
    found = rate_changes(UP_HZ * factor) if first else rate_changes(down=DOWN_HZ * factor)
    assert not judge_timer(found).passed


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (RateChanges(CRASHED), "unhandled exception", ""),
        (RateChanges(SILENT), "no spin", ""),
        (RateChanges(RUNNING, ((refused({RATE: UP_HZ}, "no"), None, 0),)), "good value refused", "10.0"),
        (RateChanges(RUNNING, ((answer({RATE: UP_HZ}, answered=False), None, 0),)), "no answer", "10.0"),
        (rate_changes(1.0), "timer not replaced", "cancel the timer"),
        (rate_changes(down=10.0), "only one change followed", "the condition"),
        (rate_changes(13.0), "wrong rate", "13 Hz, not at 10 Hz"),
        (rate_changes(down=1.75), "old timer kept", "the 1 Hz of an older timer"),
        (rate_changes(down=12.1), "old timer kept", "1 Hz and 10 Hz of an older timer"),
        (rate_changes(11.0, 11.7), "old timer kept", "11.7 Hz"),
        (rate_changes(2.0, 2.0), "timer not replaced", "cancel the timer"),
        (rate_changes(0.1), "rate used as a period", "a rate in Hz"),
        (rate_changes(None), "rate used as a period", ""),
        (rate_changes(down=1.0), "rate made a whole number", "0.75 is treated as 1"),
        (rate_changes(down=2.5), "wrong rate", "2.5 Hz"),
        (rate_changes(5.0), "wrong rate", "5 Hz, not at 10 Hz"),
        (rate_changes(0.3), "wrong rate", "0.3 Hz, not at 10 Hz"),
        (rate_changes(None, seen=BROKEN_LATER), "unhandled exception", "line 12"),
    ],
)
def test_timer_fails(found: RateChanges, cause: str, word: str) -> None:
    assert_failed(judge_timer(found), cause, word)
