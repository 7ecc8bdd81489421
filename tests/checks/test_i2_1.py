"""I2.1: made answers of a parameterized publisher, and what must be said of each."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i2_1.facts import (
    BAD_RATES,
    DOWN_HZ,
    ENABLED,
    LAUNCH_HZ,
    PREFIX,
    RATE,
    REFUSING_HZ,
    SLOW_LAUNCH_HZ,
    TOPIC,
    TYPE,
    UP_HZ,
    AtomicRequests,
    BadRates,
    ParameterStarts,
    PlainStart,
    RateChanges,
    RuntimeChanges,
    messages_naming_rate,
)
from checks.i2_1.judges import (
    judge_atomic,
    judge_bad_launch,
    judge_changes,
    judge_defaults,
    judge_launch,
    judge_runtime,
    judge_shutdown,
    judge_timer,
    judge_validation,
    judge_validation_so_far,
)
from tests.checks.made import (
    CRASH,
    CRASHED,
    KEYBOARD_INTERRUPT,
    NO_NODE,
    UP,
    answer,
    assert_failed,
    assert_passed,
    ending,
    exited,
    graph,
    log,
    parameter,
    refused,
    sample,
    samples,
    trace,
)
from tests.judge.real import crash
from tutor.judge.rates import Rate
from tutor.judge.trace import Sample, SetAnswer, Trace
from tutor.judge.verdict import Verdict
from tutor.ros_model import Parameter

PUBLISHING = graph(publishers={TOPIC: TYPE})
RUNNING = trace(*samples(TOPIC, 1.0), graph=PUBLISHING)
SILENT = trace(graph=PUBLISHING)
BROKEN_LATER = replace(RUNNING, output=CRASHED.output, exit=exited(1, after_s=9.0))
UNANSWERED = answer({}, answered=False)


def rate(hz: float) -> Rate:
    return Rate(hz, 10, 9 / hz)


# --- defaults ----------------------------------------------------------------

GOOD = (parameter(PREFIX, "string", "Hello"), parameter(RATE, "double", 1.0), parameter(ENABLED, "boolean", True))


def plain_start(parameters: tuple[Parameter, ...] | None = GOOD, seen: Trace = RUNNING, **more: Any) -> PlainStart:
    return PlainStart(seen, parameters, more.get("ending", ending(0)))


@pytest.mark.parametrize("parameters", [GOOD, tuple(reversed(GOOD)), (*GOOD, parameter("more", "integer", 3))])
def test_defaults(parameters: tuple[Parameter, ...]) -> None:
    assert_passed(judge_defaults(plain_start(parameters)))


def but(wrong: Parameter) -> tuple[Parameter, ...]:
    return tuple(wrong if wrong.name == each.name else each for each in GOOD)


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (plain_start(None, CRASHED), "unhandled exception", "line 12"),
        (plain_start(None, NO_NODE), "no node", ""),
        (plain_start(None), "no spin", "/node"),
        (plain_start(()), "parameter not declared", PREFIX),
        (plain_start(GOOD[:2]), "parameter not declared", f"declare_parameter('{ENABLED}', True)"),
        (plain_start(but(parameter(RATE, "integer", 1))), "integer parameter", "publish_rate', 1.0)"),
        (plain_start(but(parameter(RATE, "string", "1.0"))), "wrong parameter type", "string, not double"),
        (plain_start(but(parameter(ENABLED, "string", "true"))), "wrong parameter type", ENABLED),
        (plain_start(but(parameter(PREFIX, "not set", None))), "wrong parameter type", "not set"),
        (plain_start(but(parameter(PREFIX, "string", "hello"))), "wrong default", "'hello', not 'Hello'"),
        (plain_start(but(parameter(RATE, "double", 2.0))), "wrong default", "2.0, not 1.0"),
        (plain_start(but(parameter(ENABLED, "boolean", False))), "wrong default", "false, not true"),
    ],
)
def test_defaults_not(found: PlainStart, cause: str, word: str) -> None:
    assert_failed(judge_defaults(found), cause, word)


# --- at start-up -------------------------------------------------------------


def launched(
    hz: float | None = LAUNCH_HZ,
    said: str = "Ahoy7 1",
    loud: Trace | None = None,
    disabled: Trace = SILENT,
    held: object = False,
    woken: Sample | None = None,
    slow_hz: float | None = SLOW_LAUNCH_HZ,
    slow: Trace = RUNNING,
) -> ParameterStarts:
    seen = loud or trace(*samples(TOPIC, LAUNCH_HZ, data=said), graph=PUBLISHING)
    held_now = None if held is None else parameter(ENABLED, "boolean", held)
    slow_rate = rate(slow_hz) if slow_hz else None
    return ParameterStarts(
        "Ahoy7", seen, rate(hz) if hz else None, 10, slow, slow_rate, 4, disabled, held_now, 2.2, woken
    )


WOKEN = sample(TOPIC, "Hello 1", 1005.0)
NO_PUBLISHER = trace(graph=UP)
SAID = samples(TOPIC, LAUNCH_HZ, data="Ahoy7 1")
AT_FIRST_WITHOUT = trace(sample(TOPIC, "Hello 0", 1000.5), *SAID, graph=PUBLISHING)
IN_THE_END_WITHOUT = trace(*SAID, sample(TOPIC, "Hello 11", 1004.0), graph=PUBLISHING)


@pytest.mark.parametrize(
    "found",
    [
        launched(),
        launched(4.1),
        launched(5.9),
        launched(slow_hz=1.3),
        launched(held=None),
        launched(disabled=NO_PUBLISHER, woken=WOKEN),
        launched(loud=AT_FIRST_WITHOUT),
    ],
)
def test_launch(found: ParameterStarts) -> None:
    assert_passed(judge_launch(found))


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (launched(loud=CRASHED), "unhandled exception", "no message"),
        (launched(loud=trace(graph=UP)), "no publisher", TOPIC),
        (launched(loud=SILENT), "no messages", TOPIC),
        (launched(said="Hello 1"), "parameter ignored", PREFIX),
        (launched(loud=IN_THE_END_WITHOUT), "parameter ignored", "Hello 11"),
        (launched(slow_hz=1.0), "rate made a whole number", "treated as 1"),
        (launched(slow_hz=2.0), "rate made a whole number", "treated as 2"),
        (launched(hz=2.0, slow_hz=2.0), "parameter ignored", "publish_rate"),
        (launched(slow_hz=2.5), "wrong rate", "publish_rate:=1.5: 2.50 Hz"),
        (launched(slow_hz=None, slow=CRASHED), "unhandled exception", "line 12"),
        (launched(1.0), "parameter ignored", RATE),
        (launched(0.2), "rate used as a period", "1.0 / "),
        (launched(None), "rate used as a period", "not 5.0 Hz"),
        (launched(10.0), "wrong rate", "10.00 Hz"),
        (launched(disabled=RUNNING), "parameter ignored", ENABLED),
        (launched(disabled=SILENT, held=True), "parameter ignored", ENABLED),
        (launched(disabled=CRASHED), "unhandled exception", "silence, but not because"),
        (launched(disabled=NO_PUBLISHER, held=None), "parameter ignored", ENABLED),
        (launched(disabled=NO_PUBLISHER, held=None, woken=WOKEN), "parameter ignored", ENABLED),
        (launched(disabled=NO_PUBLISHER, held=True, woken=WOKEN), "parameter ignored", ENABLED),
        (launched(disabled=NO_PUBLISHER), "parameter ignored", ENABLED),
        (launched(disabled=trace(graph=UP, exit=exited(0)), woken=WOKEN), "exit at once", "silence, but not because"),
    ],
)
def test_launch_not(found: ParameterStarts, cause: str, word: str) -> None:
    assert_failed(judge_launch(found), cause, word)


# --- while it runs -----------------------------------------------------------


AGAIN = samples(TOPIC, 1.0, count=3, data="Gruezi9 5")


def switched(**but: Any) -> RuntimeChanges:
    facts: dict[str, Any] = {
        "trace": RUNNING,
        "set_prefix": answer({PREFIX: "Servus7"}),
        "after_prefix": sample(TOPIC, "Servus7 3", 1003.0),
        "set_off": answer({ENABLED: False}),
        "off_for_s": 2.5,
        "set_later": answer({PREFIX: "Gruezi9"}),
        "set_on": answer({ENABLED: True}),
        "resumed": sample(TOPIC, "Gruezi9 4", 1008.0),
        "before": rate(1.0),
        "again": AGAIN,
        "rate": rate(1.0),
        **but,
    }
    return RuntimeChanges(**facts)


ENDS_THERE = switched(set_later=None, set_on=None, resumed=None, again=(), rate=None)
"""What is seen where a change is refused or ignored: no more is asked for then."""

UNHEARD = switched(before=None)


def not_set(reason: str, answered: bool = True) -> SetAnswer:
    return answer({ENABLED: False}, reason, successful=False, answered=answered)


WRONG_TYPE = "Wrong parameter type, expected 'Type.STRING' got 'Type.BOOL'"


def runtime(seen: RuntimeChanges, timer: RateChanges | None = None) -> Verdict:
    return judge_runtime(seen, timer or retimed())


def test_runtime() -> None:
    assert_passed(runtime(switched()))
    assert_passed(runtime(switched(after_prefix=sample(TOPIC, "say Servus7", 1003.0))))
    assert_passed(runtime(switched(again=samples(TOPIC, 1.0, data="Gruezi9: Hello World"))))
    assert_passed(runtime(switched(rate=rate(2.1), base_hz=2.0)))


def test_a_rate_that_was_wrong_before_is_not_the_switchs_fault() -> None:
    assert_passed(runtime(switched(before=rate(5.2), rate=rate(5.0))))


def test_what_is_due_while_disabled_is_not_sent_later() -> None:
    late = [sample(TOPIC, f"Gruezi9 {n}", 1008.0 + n / 100) for n in range(3)]
    seen = switched(trace=trace(*late, graph=PUBLISHING))
    assert_failed(runtime(seen), "messages held back", "3 messages at once")
    assert_passed(runtime(switched(trace=trace(*late[:2], graph=PUBLISHING))))
    assert_passed(runtime(seen, retimed(UP_HZ + 1.0, DOWN_HZ + 11.0)))
    fast = [sample(TOPIC, f"Gruezi9 {n}", 1008.0 + n / 10) for n in range(9)]
    assert_passed(runtime(switched(trace=trace(*fast, graph=PUBLISHING), before=rate(10.0), rate=rate(10.0))))


def test_a_timer_that_is_left_behind_by_a_rate_as_well_is_told_of_once() -> None:
    twice = retimed(UP_HZ + 1.0, DOWN_HZ + 11.0)
    assert_passed(runtime(switched(rate=rate(2.0)), twice))
    assert_failed(runtime(switched(rate=None, again=()), twice), "rate changed")
    assert_failed(runtime(switched(again=samples(TOPIC, 1.0, data="Hello 5")), twice), "parameter ignored")


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (RuntimeChanges(CRASHED), "unhandled exception", "to start with"),
        (RuntimeChanges(SILENT), "no spin", ""),
        (RuntimeChanges(RUNNING), "no spin", "no parameter call"),
        (switched(set_prefix=not_set("", answered=False)), "blocked executor", "no answer in 5 s"),
        (switched(set_off=not_set("", answered=False), trace=BROKEN_LATER), "unhandled exception", "line 12"),
        (switched(set_off=not_set("Callback returned an invalid type")), "callback returns None", ""),
        (switched(set_off=not_set(WRONG_TYPE)), "wrong parameter type", "expected 'Type.STRING'"),
        (switched(set_on=not_set("enabled has not been declared")), "parameter not declared", ""),
        (switched(set_on=not_set("no way")), "rejected", "no way"),
        (switched(after_prefix=None), "parameter ignored", 'still read "Hello"'),
        (switched(sent_while_off=samples(TOPIC, 1.0, count=2)), "parameter ignored", "2 messages"),
        (switched(set_later=not_set("no way")), "rejected", "no way"),
        (switched(set_later=not_set("", answered=False), set_on=None), "blocked executor", "no answer in 5 s"),
        (switched(again=samples(TOPIC, 1.0, data="Hello 5")), "parameter ignored", '"Hello 5"'),
        (switched(again=(*AGAIN, sample(TOPIC, "Servus7 8", 1012.0))), "parameter ignored", "Servus7 8"),
        (switched(again=samples(TOPIC, 1.0, data="HelloServus7Gruezi9")), "old prefix kept", "HelloServus7Gruezi9"),
        (switched(rate=rate(2.0)), "rate changed", "2.00 Hz"),
        (switched(rate=rate(2.0), before=None), "rate changed", "2.00 Hz"),
        (switched(rate=None, again=()), "rate changed", "no message"),
        (switched(rate=None, again=(), trace=BROKEN_LATER), "unhandled exception", "line 12"),
        (switched(resumed=None), "does not resume", ENABLED),
        (switched(resumed=None, trace=BROKEN_LATER), "unhandled exception", "line 12"),
    ],
)
def test_runtime_not(found: RuntimeChanges, cause: str, word: str) -> None:
    assert_failed(runtime(found), cause, word)


@pytest.mark.parametrize(
    ("found", "cause"),
    [
        (replace(ENDS_THERE, set_prefix=not_set("no way"), after_prefix=None, set_off=None), "rejected"),
        (replace(ENDS_THERE, after_prefix=None, set_off=None), "parameter ignored"),
        (replace(ENDS_THERE, set_off=not_set("no way")), "rejected"),
        (replace(ENDS_THERE, sent_while_off=tuple(samples(TOPIC, 1.0, count=2))), "parameter ignored"),
        (switched(again=samples(TOPIC, 1.0, data="Hello 5")), "parameter ignored"),
    ],
)
def test_a_change_that_shows_nothing_is_a_failure_whatever_comes_after_it(found: RuntimeChanges, cause: str) -> None:
    for verdict in (judge_changes(found), runtime(found), runtime(found, retimed(UP_HZ, None))):
        assert_failed(verdict, cause)


def test_a_rate_that_changed_waits_for_what_the_timer_shows() -> None:
    assert_passed(judge_changes(switched(rate=rate(2.0))))
    assert_failed(runtime(switched(rate=rate(2.0))), "rate changed")


# --- bad rates ---------------------------------------------------------------

REFUSED = tuple((refused({RATE: bad}), 1.0) for bad in BAD_RATES)


def validated(*rejected: tuple[SetAnswer, Any], hz: float | None = 1.0, seen: Trace = RUNNING, **more: Any) -> BadRates:
    return BadRates(seen, rejected=rejected or REFUSED, rate=rate(hz) if hz else None, messages=4, **more)


@pytest.mark.parametrize(
    "found",
    [
        validated(),
        validated(hz=1.15),
        validated(*((answer, 4.0) for answer, _ in REFUSED), hz=4.1, base_hz=4.0, before=4.0),
        validated(*((answer, 2.0) for answer, _ in REFUSED), hz=2.0, base_hz=2.0, before=2.0),
        validated(
            *(
                (refused({RATE: bad}, f"publish_rate: {bad} doesn't comply with floating point range"), 1.0)
                for bad in BAD_RATES
            )
        ),
    ],
)
def test_validation(found: BadRates) -> None:
    assert_passed(judge_validation(found, UNHEARD))


@pytest.mark.parametrize(
    "reason",
    [
        "Wrong parameter type or value: I need a positive float",
        "publish_rate cannot be set to this",
        "no rate that has not been declared a positive one",
        "my callback: Callback returned an invalid type",
    ],
)
def test_a_reason_of_their_own_may_have_words_of_rclpys(reason: str) -> None:
    refusing = validated(*((refused({RATE: bad}, reason), 1.0) for bad in BAD_RATES))
    assert_passed(judge_validation(refusing, UNHEARD))


def test_answers_that_are_right_so_far_are_no_failure() -> None:
    assert_passed(judge_validation_so_far(validated(hz=None)))
    assert_passed(judge_validation_so_far(BadRates(RUNNING, rejected=REFUSED[:1])))


def rejected(which: SetAnswer, held: Any = 1.0) -> BadRates:
    return validated(REFUSED[0], (which, held))


BAD = {RATE: -1.0}


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (BadRates(CRASHED), "unhandled exception", ""),
        (BadRates(RUNNING), "no spin", ""),
        (rejected(answer(BAD)), "no validation", "-1.0 was accepted"),
        (validated((answer({RATE: 0.0}), 0.0)), "no validation", "0.0 was accepted"),
        (rejected(refused(BAD, "")), "no reason given", "-1.0"),
        (rejected(refused(BAD, "  ")), "no reason given", "-1.0"),
        (rejected(answer(BAD, answered=False)), "blocked executor", "no answer"),
        (rejected(refused(BAD, "Callback returned an invalid type")), "callback returns None", ""),
        (rejected(refused(BAD, WRONG_TYPE)), "wrong parameter type", ""),
        (
            rejected(refused(BAD, "Invalid access to undeclared parameter(s): publish_rate")),
            "parameter not declared",
            "",
        ),
        (
            rejected(refused(BAD, "parameter list cannot be empty, this might be due to pre_set_parameters_callback")),
            "value dropped",
            "pre-set",
        ),
        (rejected(refused(BAD, "Trying to set a read-only parameter: publish_rate")), "rejected", "read-only"),
        (rejected(refused(BAD), -1.0), "value changed all the same", "-1.0 now"),
        (rejected(refused(BAD), None), "value changed all the same", "None"),
        (validated(hz=3.0), "value changed all the same", "3.00 Hz"),
        (
            validated(*((answer, 4.0) for answer, _ in REFUSED), hz=1.0, base_hz=4.0, before=4.0),
            "value changed all the same",
            "1.00 Hz",
        ),
        (validated(hz=None), "value changed all the same", "after the rejection"),
        (validated(hz=None, seen=BROKEN_LATER), "unhandled exception", "line 12"),
    ],
)
def test_validation_not(found: BadRates, cause: str, word: str) -> None:
    assert_failed(judge_validation(found, UNHEARD), cause, word)


# --- the timer ---------------------------------------------------------------


def retimed(up: float | None = UP_HZ, down: float | None = DOWN_HZ, seen: Trace = RUNNING) -> RateChanges:
    steps = [(answer({RATE: asked}), rate(hz) if hz else None, 9) for asked, hz in ((UP_HZ, up), (DOWN_HZ, down))]
    return RateChanges(seen, tuple(steps))


@given(st.floats(0.81, 1.19), st.floats(0.81, 1.19))
def test_a_timer_within_a_fifth_is_right(up: float, down: float) -> None:
    assert_passed(judge_timer(retimed(UP_HZ * up, DOWN_HZ * down)))


@given(st.booleans(), st.floats(0.01, 0.79) | st.floats(1.21, 20))
def test_any_other_timer_is_wrong(first: bool, factor: float) -> None:
    found = retimed(UP_HZ * factor) if first else retimed(down=DOWN_HZ * factor)
    assert not judge_timer(found).passed


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (RateChanges(CRASHED), "unhandled exception", ""),
        (RateChanges(SILENT), "no spin", ""),
        (RateChanges(RUNNING, ((refused({RATE: UP_HZ}, "no"), None, 0),)), "rejected", "10.0"),
        (RateChanges(RUNNING, ((answer({RATE: UP_HZ}, answered=False), None, 0),)), "blocked executor", "10.0"),
        (retimed(1.0), "timer not replaced", "cancel the timer"),
        (retimed(down=10.0), "timer not replaced", "cancel the timer"),
        (retimed(13.0), "old timer kept", "13.0 Hz"),
        (retimed(down=12.1), "old timer kept", "12.1 Hz"),
        (retimed(11.0, 11.7), "old timer kept", "11.7 Hz"),
        (retimed(2.0, 2.0), "timer not replaced", "cancel the timer"),
        (retimed(0.1), "rate used as a period", "1.0 / "),
        (retimed(None), "rate used as a period", ""),
        (retimed(down=1.0), "rate made a whole number", "1.0 / rate"),
        (retimed(down=1.0), "rate made a whole number", "0.7 is treated as 1"),
        (retimed(down=2.5), "old timer kept", "2.5 Hz"),
        (retimed(5.0), "wrong rate", "5.0 Hz instead of 10 Hz"),
        (retimed(0.3), "wrong rate", "0.3 Hz"),
        (retimed(None, seen=BROKEN_LATER), "unhandled exception", "line 12"),
    ],
)
def test_timer_not(found: RateChanges, cause: str, word: str) -> None:
    assert_failed(judge_timer(found), cause, word)


# --- bonus -------------------------------------------------------------------

BEFORE = ("Hello", 1.0)


def atomic(**but: Any) -> AtomicRequests:
    facts: dict[str, Any] = {
        "trace": RUNNING,
        "answers": (refused({PREFIX: "a", RATE: -1.0}), refused({RATE: -1.0, PREFIX: "b"})),
        "before": BEFORE,
        "values": (BEFORE, BEFORE),
        "rate": rate(1.0),
        **but,
    }
    return AtomicRequests(messages=4, **facts)


def test_a_rate_that_is_another_one_from_the_start_stays() -> None:
    # A node that never looks at publish_rate breaks other criteria.
    fixed = switched(before=rate(2.05))
    assert_passed(judge_validation(validated(hz=2.0), fixed))
    assert_passed(judge_atomic(atomic(rate=rate(2.0)), fixed))
    assert_failed(judge_validation(validated(hz=5.0), fixed), "value changed all the same")
    assert_failed(judge_validation(validated(hz=None), fixed), "value changed all the same")
    refused_at = [(answer, REFUSING_HZ) for answer, _ in REFUSED]
    fallen = validated(*refused_at, hz=1.0, base_hz=REFUSING_HZ, before=REFUSING_HZ)
    assert_failed(judge_validation(fallen, switched()), "value changed all the same")


def test_atomic() -> None:
    assert_passed(judge_atomic(atomic(), UNHEARD))
    assert_passed(judge_atomic(atomic(rate=rate(2.1), base_hz=2.0), UNHEARD))


ACCEPTED, NO_ANSWER = answer({RATE: -1.0}), answer({RATE: -1.0}, answered=False)
NO = refused({RATE: -1.0})


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (AtomicRequests(CRASHED), "unhandled exception", ""),
        (AtomicRequests(RUNNING), "no spin", ""),
        (atomic(answers=(NO, NO_ANSWER)), "blocked executor", "no answer"),
        (atomic(answers=(NO, ACCEPTED)), "no validation", "accepted"),
        (atomic(answers=(ACCEPTED, NO)), "no validation", "accepted"),
        (atomic(answers=(refused(BAD, "x has not been declared"), NO)), "parameter not declared", ""),
        (atomic(values=(("a", 1.0), BEFORE)), "partial change", "('a', 1.0)"),
        (atomic(values=(BEFORE, ("Hello", -1.0))), "partial change", "-1.0"),
        (atomic(shown=sample(TOPIC, "Partial1 3", 1005.0)), "partial change", "Partial1 3"),
        (atomic(rate=None), "partial change", "the timer was touched"),
        (atomic(rate=rate(5.0)), "partial change", "5.00 Hz"),
    ],
)
def test_atomic_not(found: AtomicRequests, cause: str, word: str) -> None:
    assert_failed(judge_atomic(found, UNHEARD), cause, word)


COMPLAINT = "publish_rate must be > 0"


def start(bad: float, **more: Any) -> Trace:
    return replace(trace(**more), parameters={RATE: bad})


def starts(**more: Any) -> list[Trace]:
    return [start(bad, **more) for bad in BAD_RATES]


@pytest.mark.parametrize(
    "seen",
    [
        starts(logs=[log(COMPLAINT, 40)]),
        starts(out=COMPLAINT),
        starts(err=f"[ERROR] [1.5] [node]: {COMPLAINT}"),
        starts(err=crash(f"raise ValueError('{COMPLAINT}')"), exit=exited(1)),
        starts(logs=[log("publish_rate: 1.0 Hz")], err=COMPLAINT),
    ],
)
def test_a_bad_rate_at_start_up_is_named(seen: list[Trace]) -> None:
    assert_passed(judge_bad_launch(plain_start(seen=trace(logs=[log("publish_rate: 1.0 Hz")])), seen))


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (starts(), "no validation", "publish_rate:=0.0"),
        ([start(0.0, err=COMPLAINT), start(-1.0)], "no validation", "publish_rate:=-1.0"),
        (starts(err=crash("publish_rate = 0\n1 / publish_rate"), exit=exited(1)), "only a traceback", "ZeroDivision"),
        (starts(logs=[log("bad frequency 0.0", 40), log("going on")]), "parameter not named", "bad frequency 0.0"),
        (starts(err=CRASH, exit=exited(1)), "only a traceback", "AttributeError"),
        (starts(logs=[log("publish_rate: 0.0 Hz")]), "no validation", ""),
        (starts(err="[INFO] [7.5] [node]: publish_rate: -1.0 Hz"), "no validation", ""),
    ],
)
def test_a_bad_rate_at_start_up_is_not_named(seen: list[Trace], cause: str, word: str) -> None:
    plain = plain_start(seen=trace(logs=[log("publish_rate: 1.0 Hz")]))
    assert_failed(judge_bad_launch(plain, seen), cause, word)


def test_what_names_the_rate() -> None:
    seen = trace(logs=[log("publish_rate 1"), log("rate 2")], out="my publish_rate", err=crash("publish_rate"))
    assert messages_naming_rate(seen) == [
        "publish_rate 1",
        "my publish_rate",
        "NameError: name 'publish_rate' is not defined",
    ]


def test_shutdown() -> None:
    assert_passed(judge_shutdown(plain_start()))
    assert_passed(judge_shutdown(plain_start(ending=ending(130))))
    assert_failed(judge_shutdown(plain_start(ending=ending(1, err=KEYBOARD_INTERRUPT))), "traceback on exit")
    assert_failed(judge_shutdown(plain_start(seen=CRASHED, ending=None)), "unhandled exception")
