"""I2.1: what is asked of the node, and the facts that are gathered."""

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
UP_HZ, DOWN_HZ = 10.0, 0.7
"""The slower ones show a rate that is made a whole number: 1 and 2 Hz are both beyond the tolerance."""

REFUSING_HZ = 3.0
"""Bad rates are asked for at this rate, so that falling back to the default one shows. A forgotten timer of 1 Hz beside
it is well beyond the tolerance: at 4 Hz it would be just beyond, and measured as within it now and then."""

BAD_RATES = (0.0, -1.0)
ANSWER_S = 5.0
"""A parameter call is answered within this time, else it is not answered."""

BURST = 3
"""This many messages in half a period were held back until then: a node sends two at most, if it sends one at once."""

RARE_S = 3.0
"""At 1 Hz or more, a publisher that exists sends something within this time, late as it may be."""


@dataclass(frozen=True)
class PlainStart:
    """A plain start. `parameters` is None where no node answered; `ending` where the process had ended by itself.

    Here and below, `stuck` is where the node was, innermost frame first, when it answered nothing; `answering`: it
    answered, though it published nothing.
    """

    trace: Trace
    parameters: tuple[Parameter, ...] | None
    ending: Ending | None
    stuck: tuple[Frame, ...] = ()

    def value_of(self, name: str) -> Parameter | None:
        return find_parameter(self.parameters or (), name)


@dataclass(frozen=True)
class ParameterStarts:
    """Starts with parameters: one with a prefix and a rate, one with a slower rate, one with enabled false.

    `woken`: the first message after the last one has had enabled set to true, where it had no publisher to begin with.
    """

    prefix: str
    trace: Trace
    rate: Rate | None
    messages: int
    slow: Trace
    slow_rate: Rate | None
    slow_messages: int
    disabled: Trace
    disabled_answer: Parameter | None
    disabled_for_s: float
    woken: Sample | None = None


@dataclass(frozen=True)
class RuntimeChanges:
    """A plain start on which message_prefix and enabled are set: to `prefix`, off, to `later`, and on again.

    `after_prefix` and `before` are of another start: the first message with the prefix that was set there, and the rate
    until then. `again`: what came after it was on, at the latest from a period later on, `rate` the rate of it.
    """

    trace: Trace
    base_hz: float = DEFAULT_HZ
    set_prefix: SetAnswer | None = None
    after_prefix: Sample | None = None
    set_off: SetAnswer | None = None
    sent_while_off: tuple[Sample, ...] = ()
    off_for_s: float = 0.0
    set_later: SetAnswer | None = None
    set_on: SetAnswer | None = None
    resumed: Sample | None = None
    before: Rate | None = None
    again: tuple[Sample, ...] = ()
    rate: Rate | None = None
    stuck: tuple[Frame, ...] = ()
    answering: bool = False
    prefix: str = "Servus7"
    later: str = "Gruezi9"

    @property
    def period_s(self) -> float:
        """The seconds between two messages."""
        return 1 / self.base_hz


@dataclass(frozen=True)
class BadRates:
    """A plain start on which bad rates are asked for. `rejected` pairs each answer with the value held afterwards."""

    trace: Trace
    base_hz: float = DEFAULT_HZ
    before: Any = DEFAULT_HZ
    rejected: tuple[tuple[SetAnswer, Any], ...] = ()
    rate: Rate | None = None
    messages: int = 0
    stuck: tuple[Frame, ...] = ()
    answering: bool = False


@dataclass(frozen=True)
class RateChanges:
    """A plain start on which publish_rate is set to a faster and then to a slower rate."""

    trace: Trace
    steps: tuple[tuple[SetAnswer, Rate | None, int], ...] = ()
    stuck: tuple[Frame, ...] = ()
    answering: bool = False


@dataclass(frozen=True)
class AtomicRequests:
    """A plain start with two atomic requests: the values before and after each, and a message that shows a change."""

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


def find_parameter(parameters: Sequence[Parameter], name: str) -> Parameter | None:
    """The parameter of this name, or None."""
    return next((parameter for parameter in parameters if parameter.name == name), None)


def text_of(sample: Sample) -> str:
    """What a message says."""
    return str(sample.message["data"])


def messages_naming_rate(trace: Trace) -> list[str]:
    """The messages, logged or printed, that name publish_rate; the source lines in a traceback do not count."""
    lines = [*(log.text for log in trace.logs), *tracebacks.lines_without_tracebacks(trace.output)]
    return [line for line in lines if RATE in line]
