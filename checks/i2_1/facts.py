"""I2.1: the requirements, and the facts that the scenarios gather for the judges."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tutor.judge import tracebacks
from tutor.judge.rates import Rate
from tutor.judge.trace import Ending, Sample, SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.ros_model import Parameter

FILE = "parameterized_publisher.py"
TOPIC = "/chatter"
TYPE = "std_msgs/msg/String"
PREFIX, RATE, ENABLED = "message_prefix", "publish_rate", "enabled"

DEFAULTS: Mapping[str, tuple[str, Any]] = {
    PREFIX: ("string", "Hello"),
    RATE: ("double", 1.0),
    ENABLED: ("boolean", True),
}
DEFAULT_HZ = 1.0
LAUNCH_HZ, SLOW_LAUNCH_HZ = 5.0, 1.5
UP_HZ, DOWN_HZ = 10.0, 0.75
"""The slower ones of each pair expose rounding: 1 and 2 Hz are both out of tolerance."""

VALIDATION_HZ = 3.0
"""The node publishes at this rate when it is asked for bad ones, so that a fallback to the default rate shows.

It also exposes a forgotten 1 Hz timer, whose extra messages are well out of tolerance; at 4 Hz, they would be only
just out of it, and sometimes measured as within."""

BAD_RATES = (0.0, -1.0)
ANSWER_S = 5.0
"""Timeout of a parameter call."""

MIN_BURST = 3
"""Messages in half a period that prove a backlog: without one, there are two at most, if the node publishes at once."""

MESSAGE_GAP_S = 3.0
"""Time within which an existing publisher of at least 1 Hz sends something, even on a slow machine."""


@dataclass(frozen=True)
class PlainStart:
    """A start without parameters, interrupted with Ctrl+C at the end.

    `parameters`: None if no node answered. `ending`: None if the process had already exited.

    Here and in the classes below, `stuck` is the stack, innermost frame first, of a node that answered nothing, and
    `answering` says that a node answered although it published nothing.
    """

    trace: Trace
    parameters: tuple[Parameter, ...] | None
    ending: Ending | None
    stuck: tuple[Frame, ...] = ()

    def value_of(self, name: str) -> Parameter | None:
        return find_parameter(self.parameters or (), name)


@dataclass(frozen=True)
class RatedStart:
    """A start with a rate, and perhaps a prefix: the rate measured, and the number of messages it is based on.

    `took_rate`: whether the node took the given rate: it publishes at it, or reports it as the parameter's value.
    """

    trace: Trace
    rate: Rate | None
    messages: int
    took_rate: bool = False


@dataclass(frozen=True)
class DisabledStart:
    """A start with `enabled` false: the parameter that the node reports, and how long its silence was observed.

    `first_after_enable`: its first message once `enabled` is true; tried only if it began without a publisher.
    """

    trace: Trace
    enabled: Parameter | None
    quiet_s: float
    first_after_enable: Sample | None = None


@dataclass(frozen=True)
class ParameterStarts:
    """Three starts with parameters: with `prefix` and a fast rate, with a slow rate, and with `enabled` false.

    None for each that has not ended yet.
    """

    prefix: str
    fast: RatedStart | None = None
    slow: RatedStart | None = None
    disabled: DisabledStart | None = None

    @property
    def took_rate(self) -> bool:
        """Whether the node took a good publish_rate at start-up."""
        return any(start is not None and start.took_rate for start in (self.fast, self.slow))

    @property
    def trace(self) -> Trace | None:
        """The trace of a start that has ended."""
        return next((each.trace for each in (self.fast, self.slow, self.disabled) if each is not None), None)


@dataclass(frozen=True)
class RuntimeChanges:
    """A plain start on which parameters are set: message_prefix to `prefix`, enabled off, `later`, enabled on again.

    Some facts come from another start. `set_true`: the answer to enabled set to true, which it was, right after the
    prefix; `went_on`: whether messages came afterwards; `inverts`: they did not, but did once it was set to true again.
    `after_prefix`: the first message with the new prefix; `before`: the rate up to then; `sent_after_rate`: the
    messages sent although enabled was off, after publish_rate was set.
    `resumed`: the first message after `enabled` was on again. `after_resume`: the messages from then on or from a
    period later, with their `rate`.
    """

    trace: Trace
    base_hz: float = DEFAULT_HZ
    set_prefix: SetAnswer | None = None
    set_true: SetAnswer | None = None
    went_on: bool = True
    inverts: bool = False
    after_prefix: Sample | None = None
    set_off: SetAnswer | None = None
    sent_while_off: tuple[Sample, ...] = ()
    sent_after_rate: tuple[Sample, ...] = ()
    set_later: SetAnswer | None = None
    set_on: SetAnswer | None = None
    resumed: Sample | None = None
    before: Rate | None = None
    after_resume: tuple[Sample, ...] = ()
    rate: Rate | None = None
    stuck: tuple[Frame, ...] = ()
    answering: bool = False
    prefix: str = "Servus7"
    later: str = "Gruezi9"

    @property
    def period_s(self) -> float:
        """The time between two messages, in seconds."""
        return 1 / self.base_hz


@dataclass(frozen=True)
class BadRates:
    """A plain start on which bad rates are set.

    `before`: the value of publish_rate before that, and `rate_before` the measured rate, if it had just been set.
    `rejected`: each answer with the value afterwards. `rate`, `messages`: what the node publishes then.
    `set_good`: the answer to a good rate, if it was rejected; nothing is measured then.
    """

    trace: Trace
    base_hz: float = DEFAULT_HZ
    before: Any = DEFAULT_HZ
    rejected: tuple[tuple[SetAnswer, Any], ...] = ()
    rate: Rate | None = None
    messages: int = 0
    stuck: tuple[Frame, ...] = ()
    answering: bool = False
    rate_before: Rate | None = None
    set_good: SetAnswer | None = None


@dataclass(frozen=True)
class RateChanges:
    """A plain start on which publish_rate is set to a faster and then to a slower rate.

    `steps`: for each change, the answer, the measured rate, and the number of messages it was measured from.
    """

    trace: Trace
    steps: tuple[tuple[SetAnswer, Rate | None, int], ...] = ()
    stuck: tuple[Frame, ...] = ()
    answering: bool = False


@dataclass(frozen=True)
class AtomicRequests:
    """A plain start with two atomic requests that must be rejected.

    `before`, `values`: the prefix and the rate before both, and after each. `shown`: a message with a rejected prefix.
    `set_good`: the answer to an atomic request of good values, made last.
    """

    trace: Trace
    base_hz: float = DEFAULT_HZ
    answers: tuple[SetAnswer, ...] = ()
    before: tuple[Any, ...] = ()
    values: tuple[tuple[Any, ...], ...] = ()
    shown: Sample | None = None
    rate: Rate | None = None
    messages: int = 0
    stuck: tuple[Frame, ...] = ()
    answering: bool = False
    set_good: SetAnswer | None = None


def find_without_prefix(samples: Sequence[Sample], prefix: str) -> list[Sample]:
    """Those of the last two messages that lack the prefix: an earlier one may have been sent before it was read."""
    return [sample for sample in samples[-2:] if prefix not in text_of(sample)]


def find_parameter(parameters: Sequence[Parameter], name: str) -> Parameter | None:
    """The parameter of this name, or None."""
    return next((parameter for parameter in parameters if parameter.name == name), None)


def text_of(sample: Sample) -> str:
    """The text of a message."""
    return str(sample.message["data"])


def messages_naming_rate(trace: Trace) -> list[str]:
    """The lines, logged or printed, that name publish_rate; source lines in a traceback do not count.

    Nor does rclpy's complaint that a parameter is already declared, which has nothing to do with its value.
    """
    lines = [*(log.text for log in trace.logs), *tracebacks.lines_without_tracebacks(trace.output)]
    return [line for line in lines if RATE in line and "ParameterAlreadyDeclaredException" not in line]
