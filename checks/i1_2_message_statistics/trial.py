"""I1.2: a trial: one run of the node, what it was sent, and what it has logged since."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from statistics import median
from typing import Any

from checks.i1_2_message_statistics.log_lines import Line, parse_log
from tutor.exercise import Program, Topic
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Ending, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.wording import output_tail
from tutor.ros_model import TopicEndpoint

PROGRAM = Program("message_stats.py")
CHATTER = Topic("/chatter", "std_msgs/msg/String")
OURS = TopicEndpoint(CHATTER.name, CHATTER.type, "/talker")

SUMMARY_EVERY = 10
"""Number of messages after which the exercise asks for another summary."""

SHOWN = 8
"""The most log messages, or summaries, that are shown of a failing node."""

LATE_S = 1.1
"""Time limit of a summary after its message: it may wait for a one-second timer, which is a common choice."""

SOON_S = 0.5
"""Latency bound of a log message that the callback writes immediately."""

MAX_CPU_WAIT_S = 1.0
"""Maximum allowance for a late log message, however busy the machine: a later one belongs to no message."""

ROUGH_S = 0.15
"""If the node waits longer for a CPU it may lose messages; if ours are more uneven, there is no single true rate."""

STALL_S = 0.1
"""A node that waited this long for a CPU between two messages may still have been late for the second one."""


@dataclass(frozen=True, slots=True)
class Sent:
    """One of our `Hello World: N`: N, when it was sent, and for how long the node had waited for a CPU by then."""

    number: int
    at: float
    cpu_wait_s: float = 0.0

    @property
    def content(self) -> str:
        """The data of the message."""
        return f"Hello World: {self.number}"


@dataclass(frozen=True)
class Trial:
    """One run of the node, and the messages that it was sent.

    `breaks`: after how many messages N was to jump, or another publisher to take over. `first_publisher_left_at`: when
    the first publisher left (seconds since the epoch; 0.0 if it stayed). `cpu_wait_s`: for how long the node waited for
    a CPU while the messages were sent. `spins`: whether the node answered a request; if not, `stuck` holds the stack
    frames where it was. `new_subscriptions`: how many more the node made while the messages were sent.
    """

    trace: Trace
    sent: tuple[Sent, ...] = ()
    breaks: tuple[int, ...] = ()
    first_publisher_left_at: float = 0.0
    cpu_wait_s: float = 0.0
    spins: bool = True
    stuck: tuple[Frame, ...] = ()
    ending: Ending | None = None
    new_subscriptions: int = 0

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """What the node logged since the first message, oldest first."""
        times = [message.at for message in self.sent]
        logs = sorted(self.trace.logs, key=lambda log: log.stamp)
        numbered = ((log, bisect_right(times, log.stamp)) for log in logs)
        return tuple(parse_log(log, messages) for log, messages in numbered if messages)

    @property
    def jumps(self) -> tuple[int, ...]:
        """For each break after which a message was sent, the number of messages sent before it."""
        return tuple(before for before in self.breaks if before < len(self.sent))

    @property
    def before_break(self) -> int:
        """The number of messages sent before the first break; 0 if none was sent after it."""
        return self.jumps[0] if self.jumps else 0

    def missed(self, messages: int) -> tuple[int, ...]:
        """How many numbers each jump left out, for the jumps within the first `messages` messages."""
        due = [before for before in self.jumps if before <= messages]
        return tuple(self.sent[before].number - self.sent[before - 1].number - 1 for before in due)

    @cached_property
    def order(self) -> dict[int, int]:
        """How many messages had been sent when that with this N had been; the last one, if N came twice."""
        return {message.number: count for count, message in enumerate(self.sent, start=1)}

    @property
    def allowance_s(self) -> float:
        """How much later than usual anything may be logged, because of the machine."""
        return min(max(self.cpu_wait_s, 0.0), MAX_CPU_WAIT_S)

    @property
    def summary_limit_s(self) -> float:
        """How long after its message a summary may come, given this machine."""
        return LATE_S + self.allowance_s

    @cached_property
    def max_delay_s(self) -> float:
        """The greatest delay with which a message was sent, which is our fault, or the machine's."""
        spans = [b.at - a.at for count, (a, b) in enumerate(pairwise(self.sent), start=1) if count != self.before_break]
        return max(spans) - median(spans) if spans else 0.0

    @property
    def slowed(self) -> bool:
        """Whether the machine may be to blame for what the node logs (see `tutor.judge.bench.was_slowed`)."""
        return bool(self.sent) and max(self.cpu_wait_s, self.max_delay_s) >= ROUGH_S

    def delay_s(self, index: int) -> float:
        """How late the node may have received this message, given its waits for a CPU from then on."""
        waits = [message.cpu_wait_s for message in self.sent[index:]] + [self.sent[0].cpu_wait_s + self.cpu_wait_s]
        late = 0.0
        for before, after in pairwise(waits):
            late += max(after - before, 0.0)
            if after - before < STALL_S:
                break
        return late

    def was_hurried(self, messages: int) -> bool:
        """Whether a node that keeps one message may have lost one shortly before this many had been sent.

        That is so if it had less than half the usual time for one of the last messages: they were sent unevenly, or it
        waited for a CPU.
        """
        spans = [(b.at - a.at, b.cpu_wait_s - a.cpu_wait_s) for a, b in pairwise(self.sent)]
        usual_s = median(span_s for span_s, _ in spans) if spans else 0.0
        return any(span_s - waited_s < usual_s / 2 for span_s, waited_s in spans[max(messages - 4, 0) : messages])

    def seen(self, symptom: Symptom, **about: Any) -> Observation:
        """The observation of a symptom of the node on our topic, with what else was seen (see `Symptom.seen`)."""
        return symptom.seen(self.trace, topic=CHATTER.name, type=CHATTER.type, **about)

    def ended(self, what: str) -> Observation:
        """The node ended, having met `what`."""
        return Symptom.ENDED.seen(self.trace, answers=self.spins, says=f"the node does not survive {what}")

    @property
    def last_words(self) -> list[str]:
        """The last log messages; without any, the end of what was printed."""
        return [str(log) for log in self.trace.logs[-SHOWN:]] or list(output_tail(self.trace))
