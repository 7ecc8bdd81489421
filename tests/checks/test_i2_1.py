"""I2.1: verdicts on fabricated answers of a parameterized publisher."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i2_1_parameterized_publisher import BAD_RATES, CHATTER, CHECK
from tests.checks import builders
from tests.checks.builders import (
    CRASH,
    CRASHED,
    KEYBOARD_INTERRUPT,
    NO_NODE,
    NODE_UP,
    answer,
    assert_passed,
    assert_skipped,
    early_judge_of,
    ending,
    exited,
    graph,
    judge_of,
    log,
    parameter,
    refused,
    sample,
    samples,
    trace,
)
from tests.judge.crashes import crash
from tutor.exercise.bad_values import AtomicRequests, BadValues
from tutor.exercise.defaults import DeclaringRun
from tutor.exercise.names_bad_value import messages_naming
from tutor.exercise.rate_at_run_time import RateChanges
from tutor.exercise.run_time_changes import RunTimeChanges
from tutor.exercise.set_at_start import Started, StartedWithParameters
from tutor.judge.rates import Rate
from tutor.judge.trace import Sample, SetAnswer, Trace
from tutor.judge.verdict import Status, Verdict
from tutor.ros_model import Parameter

TOPIC, TYPE = CHATTER.name, CHATTER.type
PREFIX, RATE, ENABLED = "message_prefix", "publish_rate", "enabled"
LAUNCH_HZ, SLOW_LAUNCH_HZ = 5.0, 1.5
UP_HZ, DOWN_HZ = 10.0, 0.75
VALIDATION_HZ = 3.0

assert_failed = partial(builders.assert_failed, check=CHECK)

judge_defaults = judge_of(CHECK, "defaults")
judge_launch, judge_launch_so_far = judge_of(CHECK, "launch-params"), early_judge_of(CHECK, "launch-params")
judge_runtime, judge_changes = judge_of(CHECK, "runtime-params"), early_judge_of(CHECK, "runtime-params")
judge_validation, judge_validation_so_far = judge_of(CHECK, "validation"), early_judge_of(CHECK, "validation")
judge_timer = judge_of(CHECK, "timer")
judge_atomic = judge_of(CHECK, "atomic")
judge_bad_launch = judge_of(CHECK, "launch-validation")
judge_shutdown = judge_of(CHECK, "shutdown")

PUBLISHING = graph(publishers={TOPIC: TYPE})
RUNNING = trace(*samples(TOPIC, 1.0), graph=PUBLISHING)
SILENT = trace(graph=PUBLISHING)
BROKEN_LATER = replace(RUNNING, output=CRASHED.output, exit=exited(1, after_s=9.0))
UNANSWERED = answer({}, answered=False)


def rate(hz: float) -> Rate:
    return Rate(hz, 10, 9 / hz)


# --- defaults ----------------------------------------------------------------

GOOD = (parameter(PREFIX, "string", "Hello"), parameter(RATE, "double", 1.0), parameter(ENABLED, "boolean", True))


def plain_start(parameters: tuple[Parameter, ...] | None = GOOD, seen: Trace = RUNNING, **more: Any) -> DeclaringRun:
    return DeclaringRun(seen, parameters, more.get("ending", ending(0)))


@pytest.mark.parametrize("parameters", [GOOD, tuple(reversed(GOOD)), (*GOOD, parameter("more", "integer", 3))])
def test_defaults_pass(parameters: tuple[Parameter, ...]) -> None:
    assert_passed(judge_defaults(plain_start(parameters)))


def good_except(wrong: Parameter) -> tuple[Parameter, ...]:
    return tuple(wrong if wrong.name == each.name else each for each in GOOD)


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (plain_start(None, CRASHED), "unhandled exception", "line 12"),
        (plain_start(None, NO_NODE), "no node", ""),
        (plain_start(None), "no spin", "/node"),
        (plain_start(()), "parameter not declared", PREFIX),
        (plain_start(GOOD[:2]), "parameter not declared", f"no parameter {ENABLED}"),
        (plain_start(good_except(parameter(RATE, "integer", 1))), "integer parameter", "a decimal point"),
        (plain_start(good_except(parameter(RATE, "string", "1.0"))), "wrong parameter type", "string, not double"),
        (plain_start(good_except(parameter(ENABLED, "string", "true"))), "wrong parameter type", ENABLED),
        (plain_start(good_except(parameter(PREFIX, "not set", None))), "wrong default", "without a value"),
        (plain_start(good_except(parameter(PREFIX, "string", "hello"))), "wrong default", "as 'hello', not as 'Hello'"),
        (plain_start(good_except(parameter(RATE, "double", 2.0))), "wrong default", "as 2.0, not as 1.0"),
        (plain_start(good_except(parameter(ENABLED, "boolean", False))), "wrong default", "as false, not as true"),
    ],
)
def test_defaults_fail(found: DeclaringRun, cause: str, word: str) -> None:
    assert_failed(judge_defaults(found), cause, word)


# --- at startup --------------------------------------------------------------


def parameter_starts(
    hz: float | None = LAUNCH_HZ,
    data_sent: str = "Ahoy7 1",
    loud: Trace | None = None,
    disabled: Trace = SILENT,
    reported: object = False,
    first_after_enable: Sample | None = None,
    slow_hz: float | None = SLOW_LAUNCH_HZ,
    slow: Trace = RUNNING,
) -> StartedWithParameters:
    seen = loud or trace(*samples(TOPIC, LAUNCH_HZ, data=data_sent), graph=PUBLISHING)
    enabled = None if reported is None else parameter(ENABLED, "boolean", reported)
    slow_rate = rate(slow_hz) if slow_hz else None
    fast = Started(seen, rate(hz) if hz else None, 10)
    silent = Started(disabled, reported=enabled, quiet_s=2.2, first_after_enable=first_after_enable)
    return StartedWithParameters((fast, Started(slow, slow_rate, 4), silent))


FIRST_AFTER_ENABLE = sample(TOPIC, "Hello 1", 1005.0)
NO_PUBLISHER = trace(graph=NODE_UP)
PREFIXED = samples(TOPIC, LAUNCH_HZ, data="Ahoy7 1")
OLD_PREFIX_FIRST = trace(sample(TOPIC, "Hello 0", 1000.5), *PREFIXED, graph=PUBLISHING)
OLD_PREFIX_LAST = trace(*PREFIXED, sample(TOPIC, "Hello 11", 1004.0), graph=PUBLISHING)


@pytest.mark.parametrize(
    "found",
    [
        parameter_starts(),
        parameter_starts(4.1),
        parameter_starts(5.9),
        parameter_starts(slow_hz=1.3),
        parameter_starts(reported=None),
        parameter_starts(disabled=NO_PUBLISHER, first_after_enable=FIRST_AFTER_ENABLE),
        parameter_starts(loud=OLD_PREFIX_FIRST),
    ],
)
def test_launch_passes(found: StartedWithParameters) -> None:
    assert_passed(judge_launch(found))


@pytest.mark.parametrize(
    ("found", "cause", "word"),
    [
        (parameter_starts(loud=CRASHED), "unhandled exception", "no message"),
        (parameter_starts(loud=trace(graph=NODE_UP)), "no publisher", TOPIC),
        (parameter_starts(loud=SILENT), "no messages", TOPIC),
        (parameter_starts(data_sent="Hello 1"), "parameter ignored", PREFIX),
        (parameter_starts(loud=OLD_PREFIX_LAST), "parameter ignored", "Hello 11"),
        (parameter_starts(slow_hz=1.0), "rate made a whole number", "treated as 1"),
        (parameter_starts(slow_hz=2.0), "rate made a whole number", "treated as 2"),
        (parameter_starts(hz=2.0, slow_hz=2.0), "parameter ignored", "publish_rate"),
        (parameter_starts(slow_hz=2.5), "wrong rate", "publish_rate:=1.5: 2.50 Hz"),
        (parameter_starts(slow_hz=None, slow=CRASHED), "unhandled exception", "line 12"),
        (parameter_starts(1.0), "parameter ignored", RATE),
        (parameter_starts(0.2), "rate used as a period", "the timer waits that many seconds"),
        (parameter_starts(None), "rate used as a period", "not 5.0 Hz"),
        (parameter_starts(10.0), "wrong rate", "10.00 Hz"),
        (parameter_starts(disabled=RUNNING), "parameter ignored", ENABLED),
        (parameter_starts(disabled=SILENT, reported=True), "parameter ignored", ENABLED),
        (parameter_starts(disabled=CRASHED), "unhandled exception", "silence, but not because"),
        (parameter_starts(disabled=NO_PUBLISHER, reported=None), "parameter ignored", ENABLED),
        (
            parameter_starts(disabled=NO_PUBLISHER, reported=None, first_after_enable=FIRST_AFTER_ENABLE),
            "parameter ignored",
            ENABLED,
        ),
        (
            parameter_starts(disabled=NO_PUBLISHER, reported=True, first_after_enable=FIRST_AFTER_ENABLE),
            "parameter ignored",
            ENABLED,
        ),
        (parameter_starts(disabled=NO_PUBLISHER), "parameter ignored", ENABLED),
        (
            parameter_starts(disabled=trace(graph=NODE_UP, exit=exited(0)), first_after_enable=FIRST_AFTER_ENABLE),
            "exit at once",
            "silence, but not because",
        ),
    ],
)
def test_launch_fails(found: StartedWithParameters, cause: str, word: str) -> None:
    assert_failed(judge_launch(found), cause, word)


@pytest.mark.parametrize(
    ("fast", "cause"),
    [
        (Started(CRASHED, None, 0), "unhandled exception"),
        (Started(SILENT, None, 0), "no messages"),
        (Started(RUNNING, rate(LAUNCH_HZ), 10), "parameter ignored"),
    ],
)
def test_a_fast_start_alone_fails_launch(fast: Started, cause: str) -> None:
    verdict = judge_launch_so_far(StartedWithParameters((fast, None, None)))
    assert verdict is not None
    assert_failed(verdict, cause)


@pytest.mark.parametrize(
    ("fast", "cause"),
    [
        (
            Started(trace(*PREFIXED, graph=graph(("/node",) * 2)), rate(10.0), 10),
            "second node of the same name",
        ),
        (Started(trace(*PREFIXED, graph=PUBLISHING), Rate(10.0, 20, 1.9, 0.01), 20), "messages in bursts"),
    ],
)
def test_a_wrong_rate_at_start_up_has_a_cause_that_does_not_depend_on_the_other_start(
    fast: Started, cause: str
) -> None:
    assert_failed(judge_launch(replace(parameter_starts(), starts=(fast, *parameter_starts().starts[1:]))), cause)


@pytest.mark.parametrize(
    "found",
    [
        StartedWithParameters((None, Started(CRASHED), None)),  # the fast start may fail for a clearer cause
        StartedWithParameters((Started(trace(*PREFIXED, graph=PUBLISHING), rate(LAUNCH_HZ), 10), None, None)),
        StartedWithParameters((Started(trace(*PREFIXED, graph=PUBLISHING), rate(1.0), 10), None, None)),
        # With 2 Hz in the slow start, too, it is the rate that is ignored.
        StartedWithParameters((Started(trace(*PREFIXED, graph=PUBLISHING), rate(2.0), 10), None, None)),
    ],
)
def test_launch_is_left_open_until_all_starts_have_ended(found: StartedWithParameters) -> None:
    assert judge_launch_so_far(found) is None


SECOND_TIMER = """\
class N(Node):
    def __init__(self):
        super().__init__('n')
        self.declare_parameter('publish_rate', 1.0)
        self.first = self.create_timer(1.0, self.send)
        self.timer = self.create_timer(1 / self.get_parameter('publish_rate').value, self.send)

    def send(self):
        self.publisher.publish(String())

rclpy.spin(N())
"""


@pytest.mark.parametrize(("hz", "slow_hz"), [(7.0, SLOW_LAUNCH_HZ), (LAUNCH_HZ, 2.5)])
def test_a_second_timer_is_found_whichever_start_shows_it(hz: float, slow_hz: float) -> None:
    sources = {"node.py": SECOND_TIMER}
    seen = parameter_starts(
        hz,
        slow_hz=slow_hz,
        loud=replace(trace(*PREFIXED, graph=PUBLISHING), sources=sources),
        slow=replace(RUNNING, sources=sources),
    )
    assert_failed(judge_launch(seen), "two timers", "line 5", "line 6")


# --- while it runs -----------------------------------------------------------


AFTER_RESUME = samples(TOPIC, 1.0, count=3, data="Gruezi9 5")


def runtime_changes(**changes: Any) -> RunTimeChanges:
    facts: dict[str, Any] = {
        "trace": RUNNING,
        "set_value": answer({PREFIX: "Servus7"}),
        "after_value": sample(TOPIC, "Servus7 3", 1003.0),
        "set_off": answer({ENABLED: False}),
        "set_later": answer({PREFIX: "Gruezi9"}),
        "set_on": answer({ENABLED: True}),
        "resumed": sample(TOPIC, "Gruezi9 4", 1008.0),
        "before": rate(1.0),
        "after_resume": AFTER_RESUME,
        "rate": rate(1.0),
        **changes,
    }
    return RunTimeChanges(**facts)


STOPPED_EARLY = runtime_changes(set_later=None, set_on=None, resumed=None, after_resume=(), rate=None)
"""What is observed if a change is refused or ignored: the check then asks for no more."""

WITHOUT_RATE_BEFORE = runtime_changes(before=None)


def not_set(reason: str, answered: bool = True) -> SetAnswer:
    return answer({ENABLED: False}, reason, successful=False, answered=answered)


WRONG_TYPE = "Wrong parameter type, expected 'Type.STRING' got 'Type.BOOL'"


def judge_with_timer(seen: RunTimeChanges, timer: RateChanges | None = None) -> Verdict:
    return judge_runtime(seen, timer or rate_changes())


def test_runtime_passes() -> None:
    assert_passed(judge_with_timer(runtime_changes()))
    assert_passed(judge_with_timer(runtime_changes(after_value=sample(TOPIC, "say Servus7", 1003.0))))
    assert_passed(judge_with_timer(runtime_changes(after_resume=samples(TOPIC, 1.0, data="Gruezi9: Hello World"))))
    assert_passed(judge_with_timer(runtime_changes(rate=rate(2.1), base_hz=2.0)))


def test_a_rate_that_was_already_wrong_is_not_blamed_on_the_switch() -> None:
    assert_passed(judge_with_timer(runtime_changes(before=rate(5.2), rate=rate(5.0))))


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


# --- bad rates ---------------------------------------------------------------

REFUSED = tuple((refused({RATE: bad}), 1.0) for bad in BAD_RATES)


def bad_rates(
    *rejected: tuple[SetAnswer, Any], hz: float | None = 1.0, seen: Trace = RUNNING, **more: Any
) -> BadValues:
    return BadValues(seen, rejected=rejected or REFUSED, rate=rate(hz) if hz else None, messages=4, **more)


@pytest.mark.parametrize(
    "found",
    [
        bad_rates(),
        bad_rates(hz=1.15),
        bad_rates(*((answer, 4.0) for answer, _ in REFUSED), hz=4.1, base_hz=4.0, before=4.0),
        bad_rates(*((answer, 2.0) for answer, _ in REFUSED), hz=2.0, base_hz=2.0, before=2.0),
        # An old timer, which still runs, is judged by `timer`.
        bad_rates(*((answer, 3.0) for answer, _ in REFUSED), hz=4.2, base_hz=3.0, before=3.0, rate_before=rate(3.6)),
        bad_rates(
            *(
                (refused({RATE: bad}, f"publish_rate: {bad} doesn't comply with floating point range"), 1.0)
                for bad in BAD_RATES
            )
        ),
    ],
)
def test_validation_passes(found: BadValues) -> None:
    assert_passed(judge_validation(found, WITHOUT_RATE_BEFORE))


@pytest.mark.parametrize(
    "reason",
    [
        "Wrong parameter type or value: I need a positive float",
        "publish_rate cannot be set to this",
        "no rate that has not been declared a positive one",
        "my callback: Callback returned an invalid type",
    ],
)
def test_a_custom_reason_may_contain_wording_from_rclpy(reason: str) -> None:
    refusing = bad_rates(*((refused({RATE: bad}, reason), 1.0) for bad in BAD_RATES))
    assert_passed(judge_validation(refusing, WITHOUT_RATE_BEFORE))


def test_validation_is_not_judged_where_a_good_rate_is_rejected() -> None:
    verdict = judge_validation(bad_rates(set_good=refused({RATE: 3.0}, "not now")), WITHOUT_RATE_BEFORE)
    assert verdict.status is Status.SKIPPED
    assert "not now" in verdict.cause
    assert "see `timer`" in verdict.cause


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
        (
            bad_rates(*((answer, 4.0) for answer, _ in REFUSED), hz=1.0, base_hz=4.0, before=4.0),
            "value changed all the same",
            "1.00 Hz",
        ),
        (bad_rates(hz=None), "value changed all the same", "after the rejection"),
        (bad_rates(hz=None, seen=BROKEN_LATER), "unhandled exception", "line 12"),
    ],
)
def test_validation_fails(found: BadValues, cause: str, word: str) -> None:
    assert_failed(judge_validation(found, WITHOUT_RATE_BEFORE), cause, word)


# --- the timer ---------------------------------------------------------------


def rate_changes(up: float | None = UP_HZ, down: float | None = DOWN_HZ, seen: Trace = RUNNING) -> RateChanges:
    steps = [(answer({RATE: asked}), rate(hz) if hz else None, 9) for asked, hz in ((UP_HZ, up), (DOWN_HZ, down))]
    return RateChanges(seen, tuple(steps))


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


# --- bonus -------------------------------------------------------------------

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
    refused_at = [(answer, VALIDATION_HZ) for answer, _ in REFUSED]
    fallen = bad_rates(
        *refused_at, hz=1.0, base_hz=VALIDATION_HZ, before=VALIDATION_HZ, rate_before=rate(VALIDATION_HZ)
    )
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
    assert verdict.status is Status.SKIPPED
    assert WRONG_TYPE in verdict.cause
    assert see in verdict.cause
    assert_passed(judge_atomic(replace(found, set_good=answer(good)), switched, retimed))


COMPLAINT = "publish_rate must be > 0"
TOOK_RATE = StartedWithParameters((Started(RUNNING, rate(LAUNCH_HZ), 10, took_rate=True), None, None))


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
def test_bad_launch_passes(seen: list[Trace]) -> None:
    plain = plain_start(seen=trace(logs=[log("publish_rate: 1.0 Hz")]))
    assert_passed(judge_bad_launch(plain, seen, TOOK_RATE))


def test_bad_launch_is_not_judged_where_a_good_rate_is_not_taken() -> None:
    seen = starts(err=crash(f"raise ValueError('{COMPLAINT}')"), exit=exited(1))
    verdict = judge_bad_launch(plain_start(), seen, parameter_starts())
    assert verdict.status is Status.SKIPPED
    assert "see `launch-params`" in verdict.cause


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (starts(), "not checked at start-up", "publish_rate:=0.0"),
        ([start(0.0, err=COMPLAINT), start(-1.0)], "not checked at start-up", "publish_rate:=-1.0"),
        (
            starts(err=crash("publish_rate = 0\n1 / publish_rate"), exit=exited(1)),
            "not checked at start-up",
            "ZeroDivision",
        ),
        (starts(logs=[log("bad frequency 0.0", 40), log("going on")]), "parameter not named", "bad frequency 0.0"),
        (starts(err=CRASH, exit=exited(1)), "not checked at start-up", "AttributeError"),
        (
            starts(
                err=crash(
                    f"class ParameterAlreadyDeclaredException(Exception): ...\n"
                    f"raise ParameterAlreadyDeclaredException('{RATE}')"
                ),
                exit=exited(1),
            ),
            "not checked at start-up",
            "ParameterAlreadyDeclared",
        ),
        (starts(logs=[log("publish_rate: 0.0 Hz")]), "not checked at start-up", "no message about it"),
        (starts(err="[INFO] [7.5] [node]: publish_rate: -1.0 Hz"), "not checked at start-up", "no message about it"),
    ],
)
def test_bad_launch_fails(seen: list[Trace], cause: str, word: str) -> None:
    plain = plain_start(seen=trace(logs=[log("publish_rate: 1.0 Hz")]))
    assert_failed(judge_bad_launch(plain, seen, TOOK_RATE), cause, word)


def test_messages_naming_the_rate() -> None:
    seen = trace(logs=[log("publish_rate 1"), log("rate 2")], out="my publish_rate", err=crash("publish_rate"))
    assert messages_naming(RATE, seen) == [
        "publish_rate 1",
        "my publish_rate",
        "NameError: name 'publish_rate' is not defined",
    ]


def test_shutdown() -> None:
    assert_passed(judge_shutdown(plain_start()))
    assert_passed(judge_shutdown(plain_start(ending=ending(130))))
    assert_failed(judge_shutdown(plain_start(ending=ending(1, err=KEYBOARD_INTERRUPT))), "traceback on exit")
    assert_skipped(judge_shutdown(plain_start(seen=CRASHED, ending=None)), "`launch-params` shows why")
    silent = replace(plain_start(seen=CRASHED, ending=None), parameters=None)
    assert_skipped(judge_shutdown(silent), "`defaults` shows why")
