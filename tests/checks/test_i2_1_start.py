"""I2.1: verdicts on fabricated starts of a parameterized publisher."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from checks.i2_1_parameterized_publisher import BAD_RATES, CHECK
from tests.checks.builders import (
    CRASH,
    CRASHED,
    KEYBOARD_INTERRUPT,
    NO_NODE,
    NODE_UP,
    assert_passed,
    assert_skipped,
    early_judge_of,
    ending,
    exited,
    graph,
    judge_of,
    log,
    parameter,
    rate,
    sample,
    samples,
    trace,
)
from tests.checks.parameterized_publisher import (
    ENABLED,
    GOOD,
    LAUNCH_HZ,
    PREFIX,
    PUBLISHING,
    RATE,
    RUNNING,
    SILENT,
    SLOW_LAUNCH_HZ,
    TOPIC,
    assert_failed,
    parameter_starts,
    plain_start,
)
from tests.judge.crashes import crash
from tutor.exercise.defaults import DeclaringRun
from tutor.exercise.names_bad_value import messages_naming
from tutor.exercise.set_at_start import Started, StartedWithParameters
from tutor.judge.rates import Rate
from tutor.judge.trace import Trace
from tutor.ros_model import Parameter

judge_defaults = judge_of(CHECK, "defaults")
judge_launch, judge_launch_so_far = judge_of(CHECK, "launch-params"), early_judge_of(CHECK, "launch-params")
judge_bad_launch = judge_of(CHECK, "launch-validation")
judge_shutdown = judge_of(CHECK, "shutdown")


@pytest.mark.parametrize("parameters", [GOOD, tuple(reversed(GOOD)), (*GOOD, parameter("more", "integer", 3))])
def test_defaults_pass(parameters: tuple[Parameter, ...]) -> None:
    assert_passed(judge_defaults(plain_start(parameters)))


def good_except(wrong: Parameter) -> tuple[Parameter, ...]:
    return tuple(wrong if wrong.name == good.name else good for good in GOOD)


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


NO_PUBLISHER = trace(graph=NODE_UP)
PREFIXED = samples(TOPIC, LAUNCH_HZ, data="Ahoy7 1")
PREFIXED_TRACE = trace(*PREFIXED, graph=PUBLISHING)
OLD_PREFIX_FIRST = trace(sample(TOPIC, "Hello 0", 1000.5), *PREFIXED, graph=PUBLISHING)
OLD_PREFIX_LAST = trace(*PREFIXED, sample(TOPIC, "Hello 11", 1004.0), graph=PUBLISHING)


def enabled_later(disabled: Trace, reported: object = False) -> StartedWithParameters:
    """A node that publishes as soon as it is enabled."""
    first = sample(TOPIC, "Hello 1", 1005.0)
    return parameter_starts(disabled=disabled, reported=reported, first_after_enable=first)


@pytest.mark.parametrize(
    "found",
    [
        parameter_starts(),
        parameter_starts(4.1),
        parameter_starts(5.9),
        parameter_starts(slow_hz=1.3),
        parameter_starts(reported=None),
        enabled_later(NO_PUBLISHER),
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
        (enabled_later(NO_PUBLISHER, reported=None), "parameter ignored", ENABLED),
        (enabled_later(NO_PUBLISHER, reported=True), "parameter ignored", ENABLED),
        (parameter_starts(disabled=NO_PUBLISHER), "parameter ignored", ENABLED),
        (enabled_later(trace(graph=NODE_UP, exit=exited(0))), "exit at once", "silence, but not because"),
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
        (Started(PREFIXED_TRACE, Rate(10.0, 20, 1.9, 0.01), 20), "messages in bursts"),
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
        StartedWithParameters((Started(PREFIXED_TRACE, rate(LAUNCH_HZ), 10), None, None)),
        StartedWithParameters((Started(PREFIXED_TRACE, rate(1.0), 10), None, None)),
        # With 2 Hz in the slow start, too, it is the rate that is ignored.
        StartedWithParameters((Started(PREFIXED_TRACE, rate(2.0), 10), None, None)),
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
        loud=replace(PREFIXED_TRACE, sources=sources),
        slow=replace(RUNNING, sources=sources),
    )
    assert_failed(judge_launch(seen), "two timers", "line 5", "line 6")


COMPLAINT = "publish_rate must be > 0"
TOOK_RATE = StartedWithParameters((Started(RUNNING, rate(LAUNCH_HZ), 10, took_rate=True), None, None))
PLAIN = plain_start(seen=trace(logs=[log("publish_rate: 1.0 Hz")]))


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
    assert_passed(judge_bad_launch(PLAIN, seen, TOOK_RATE))


def test_bad_launch_is_not_judged_where_a_good_rate_is_not_taken() -> None:
    seen = starts(err=crash(f"raise ValueError('{COMPLAINT}')"), exit=exited(1))
    assert_skipped(judge_bad_launch(plain_start(), seen, parameter_starts()), "see `launch-params`")


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
    assert_failed(judge_bad_launch(PLAIN, seen, TOOK_RATE), cause, word)


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
