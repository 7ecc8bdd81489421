"""I1.2: what we send to the node, and the facts that are gathered about it."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from statistics import median

from checks.i1_2.reading import Line, parse_log
from tutor.judge.trace import Ending, Trace
from tutor.judge.tracebacks import Frame
from tutor.ros_model import TopicEndpoint

FILE = "message_stats.py"
TOPIC, TYPE = "/chatter", "std_msgs/msg/String"
OURS = TopicEndpoint(TOPIC, TYPE, "/talker")
SUMMARY_EVERY = 10
"""Number of messages after which the exercise asks for another summary."""

STEADY_HZ = (4.9, 5.0)
"""Bounds of the steady talker's constant, random rate.

Slow enough that a rate over the last second is right once ten messages have come. No common mistake gives this rate:
neither a count (10, 20), nor a count divided by the whole seconds of the time that it took (1 of 1.8 s, 3 of 3.8 s).
"""
STEADY_MESSAGES = 20
QUIET_S = 0.8
"""How long a node is up before the first message, so that a rate counted from its start is clearly too low."""

MATCH_S = 0.4
"""Once we have discovered a best-effort subscription, it has discovered our publisher within this time."""

UNTIMED_HZ = 8.0
"""The rate of messages in scenarios that do not judge rates."""
JUMP_AFTER, SECOND_JUMP_AFTER, JUMP_MESSAGES = 17, 27, 33
"""N jumps far; on another start, it also leaves out one number later.

A summary before the first jump shows what is usual at this rate: without it, a rate of 8.00 passed for a report, as it
had been 5.00 in another run. One is due soon after each jump, and after a single jump, one covers ten consecutive
messages. A node that restarts its count at the first jump reaches ten again before the end.
"""

AFTER_ZERO_MESSAGES = 12
"""On one more start, N jumps from 0; the next summary is due soon afterwards."""

FIRST_NUMBERS = (90, 97)
"""Range of the first N. It passes 100 before the jump, where nodes that compare texts or two last digits go wrong."""
LEFT_OUT = (4, 8)
"""Range of how many numbers the first jump leaves out.

With these, what N is ahead of the number expected at the jump is no count of messages, from 0 or from 1, at any time.
"""

FAST_HZ, FAST_MESSAGES = 25.0, 60
"""A stretch at a rate that is common on robots: a node that handles only ten messages per second loses a third."""
FAST_ENOUGH_HZ = 20.0
"""A machine on which our average rate stays below this is too busy."""

RESTART_AFTER, RESTART_MESSAGES = 13, 25
RESTARTED_HZ = 9.4
"""The rate of the second publisher: no rate over any of the messages since then is still UNTIMED_HZ."""
ABSENT_S = 0.7
"""How long there is no publisher: nobody restarts a talker faster."""

LATE_S = 1.1
"""Time limit of a summary after its message: it may wait for a one-second timer, which is a common choice."""

SOON_S = 0.5
"""Latency bound of a log message that the callback writes immediately."""

MAX_CPU_WAIT_S = 1.0
"""Maximum excuse for a late log message, however busy the machine: a later one belongs to no message."""

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

    `before_break`: the number of messages sent before N jumped or another publisher took over; 0 if neither happened.
    `before_second_jump`: the number sent before N jumped once more; 0 if it did not. `first_publisher_left_at`: when
    the first publisher left (seconds since the epoch; 0.0 if it stayed). `cpu_wait_s`: for how long the node waited for
    a CPU while the messages were sent. `spins`: whether the node answered a request; if not, `stuck` holds the stack
    frames where it was. `new_subscriptions`: how many more the node made while the messages were sent.
    """

    trace: Trace
    sent: tuple[Sent, ...] = ()
    before_break: int = 0
    first_publisher_left_at: float = 0.0
    cpu_wait_s: float = 0.0
    spins: bool = True
    stuck: tuple[Frame, ...] = ()
    ending: Ending | None = None
    before_second_jump: int = 0
    new_subscriptions: int = 0

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """What the node logged since the first message, oldest first."""
        times = [each.at for each in self.sent]
        logs = sorted(self.trace.logs, key=lambda log: log.stamp)
        numbered = ((log, bisect_right(times, log.stamp)) for log in logs)
        return tuple(parse_log(log, messages) for log, messages in numbered if messages)

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
        spans = [b.at - a.at for index, (a, b) in enumerate(pairwise(self.sent), start=1) if index != self.before_break]
        return max(spans) - median(spans) if spans else 0.0

    @property
    def slowed(self) -> bool:
        """Whether the machine may be why the node fails (see `tutor.judge.bench.was_slowed`)."""
        return bool(self.sent) and max(self.cpu_wait_s, self.max_delay_s) >= ROUGH_S

    def delay_s(self, index: int) -> float:
        """How late the node may have received this message, given its waits for a CPU from then on."""
        waits = [each.cpu_wait_s for each in self.sent[index:]] + [self.sent[0].cpu_wait_s + self.cpu_wait_s]
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

    @property
    def jumps(self) -> tuple[int, ...]:
        """For each jump after which a message was sent, the number of messages sent before it."""
        return tuple(before for before in (self.before_break, self.before_second_jump) if 0 < before < len(self.sent))

    def missed(self, messages: int) -> tuple[int, ...]:
        """How many numbers each jump left out, for the jumps within the first `messages` messages."""
        due = [before for before in self.jumps if before <= messages]
        return tuple(self.sent[before].number - self.sent[before - 1].number - 1 for before in due)
