"""I2.1: what could be observed of a parameterized publisher."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

from checks.i2_1_parameterized_publisher import CHATTER, CHECK
from tests.checks import builders
from tests.checks.builders import CRASHED, answer, ending, exited, graph, parameter, rate, sample, samples, trace
from tutor.exercise.defaults import DeclaringRun
from tutor.exercise.rate_at_run_time import RateChanges
from tutor.exercise.run_time_changes import RunTimeChanges
from tutor.exercise.set_at_start import Started, StartedWithParameters
from tutor.judge.trace import Sample, Trace
from tutor.ros_model import Parameter

TOPIC, TYPE = CHATTER.name, CHATTER.type
PREFIX, RATE, ENABLED = "message_prefix", "publish_rate", "enabled"
LAUNCH_HZ, SLOW_LAUNCH_HZ = 5.0, 1.5
UP_HZ, DOWN_HZ = 10.0, 0.75

assert_failed = partial(builders.assert_failed, check=CHECK)

PUBLISHING = graph(publishers={TOPIC: TYPE})
RUNNING = trace(*samples(TOPIC, 1.0), graph=PUBLISHING)
SILENT = trace(graph=PUBLISHING)
BROKEN_LATER = replace(RUNNING, output=CRASHED.output, exit=exited(1, after_s=9.0))
WRONG_TYPE = "Wrong parameter type, expected 'Type.STRING' got 'Type.BOOL'"
GOOD = (parameter(PREFIX, "string", "Hello"), parameter(RATE, "double", 1.0), parameter(ENABLED, "boolean", True))


def plain_start(parameters: tuple[Parameter, ...] | None = GOOD, seen: Trace = RUNNING, **more: Any) -> DeclaringRun:
    return DeclaringRun(seen, parameters, more.get("ending", ending(0)))


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


def rate_changes(up: float | None = UP_HZ, down: float | None = DOWN_HZ, seen: Trace = RUNNING) -> RateChanges:
    steps = [(answer({RATE: asked}), rate(hz) if hz else None, 9) for asked, hz in ((UP_HZ, up), (DOWN_HZ, down))]
    return RateChanges(seen, tuple(steps))
