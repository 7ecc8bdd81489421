"""I1.2: what is sent to the node, and the facts that are gathered."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from statistics import median

from checks.i1_2.reading import Line, read
from tutor.judge.trace import Ending, Trace
from tutor.judge.tracebacks import Frame
from tutor.ros_model import TopicEndpoint

FILE = "message_stats.py"
TOPIC, TYPE = "/chatter", "std_msgs/msg/String"
OURS = TopicEndpoint(TOPIC, TYPE, "/talker")
EVERY = 10
"""A summary is asked for after this many messages."""

STEADY_HZ = (4.9, 5.0)
"""The rate at which a steady talker sends: between these, by chance, evenly.

Slow enough that a rate taken over the last second is true as soon as ten messages are there. Ten and twenty are no such
rate, nor are ten and twenty messages by the seconds that it took, 1.8 and 3.8, when these are cut off.
"""
STEADY_MESSAGES = 20
QUIET_S = 1.0
"""A node is up for this long before the first message: a rate counted from its start is then too low to be true."""

MATCH_S = 0.4
"""A best-effort subscription that we have met has met us this much later."""

SOONER_HZ = 8.0
"""The rate where none is judged."""
JUMP_AFTER, AGAIN_AFTER, JUMP_MESSAGES = 7, 27, 33
"""N jumps twice: far, and then by leaving out one number.

A summary is due soon after each jump; between them, ten messages in a row are summed up of which none is missing. A
node that starts counting again at the first jump has counted ten more in time to be seen.
"""

FAST_HZ, FAST_MESSAGES = 25.0, 60
"""A stretch at a rate that is ordinary on a robot: a node that takes ten a second loses a third."""
FAST_ENOUGH_HZ = 20.0
"""A machine that does not let us send so fast, on the whole, is too busy."""

RESTART_AFTER, RESTART_MESSAGES = 13, 25
ABSENT_S = 0.7
"""Nobody restarts a talker in less time."""

LATE_S = 1.1
"""A summary comes this soon after its message: it may wait for a timer of one second, as people choose."""

SOON_S = 0.5
"""What is logged of a message at once is there within this time."""

MOST_CPU_WAIT_S = 1.0
"""However busy the machine: what comes later than this excuses belongs to no message."""

ROUGH_S = 0.15
"""A node kept from running for longer may have lost messages, and one that was fed so unevenly measured no one rate."""

STALL_S = 0.1
"""A node that was kept from running for this long between two messages may not have been back in time for the
second.
"""


@dataclass(frozen=True, slots=True)
class Sent:
    """One of our `Hello World: N`: N, when it was sent, and how much of the CPU the machine had owed by then."""

    number: int
    at: float
    cpu_wait_s: float = 0.0

    @property
    def content(self) -> str:
        """What a subscriber gets."""
        return f"Hello World: {self.number}"


@dataclass(frozen=True)
class Trial:
    """A start of the node, and what it was fed.

    `breaks`: how many messages were sent before N jumped or another publisher took over; 0 where neither happened.
    `again`: how many were sent before N jumped once more; 0 where it did not. `gone_at`: when the first publisher went
    away. `cpu_wait_s`: what the machine kept the node, or us, from running until all had come. `spins`: whether
    the node answered a request; if not, `stuck` says where it was.
    """

    trace: Trace
    sent: tuple[Sent, ...] = ()
    breaks: int = 0
    first_publisher_left_at: float = 0.0
    cpu_wait_s: float = 0.0
    spins: bool = True
    stuck: tuple[Frame, ...] = ()
    ending: Ending | None = None
    again: int = 0

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """What the node logged from the first message on, oldest first."""
        times = [each.at for each in self.sent]
        logs = sorted(self.trace.logs, key=lambda log: log.stamp)
        numbered = ((log, bisect_right(times, log.stamp)) for log in logs)
        return tuple(read(log, messages) for log, messages in numbered if messages)

    @property
    def allowance_s(self) -> float:
        """How much later than usual anything may be logged on this machine."""
        return min(max(self.cpu_wait_s, 0.0), MOST_CPU_WAIT_S)

    @property
    def summary_limit_s(self) -> float:
        """How long after its message a summary may come on this machine."""
        return LATE_S + self.allowance_s

    @cached_property
    def most_late_s(self) -> float:
        """How much later than due a message was sent, at worst: our fault, and the machine's."""
        spans = [b.at - a.at for index, (a, b) in enumerate(pairwise(self.sent), start=1) if index != self.breaks]
        return max(spans) - median(spans) if spans else 0.0

    @property
    def slowed(self) -> bool:
        """Whether the machine may be why the node did not do well: see `tutor.judge.bench.was_slowed`."""
        return bool(self.sent) and max(self.cpu_wait_s, self.most_late_s) >= ROUGH_S

    def delay_s(self, index: int) -> float:
        """How late the machine may have let the node take in this message: what it was kept from running thereafter."""
        owed = [each.cpu_wait_s for each in self.sent[index:]] + [self.sent[0].cpu_wait_s + self.cpu_wait_s]
        late = 0.0
        for before, after in pairwise(owed):
            late += max(after - before, 0.0)
            if after - before < STALL_S:
                break
        return late

    @property
    def jumps(self) -> tuple[int, ...]:
        """How many messages were sent before each jump, if one came after it."""
        return tuple(before for before in (self.breaks, self.again) if 0 < before < len(self.sent))

    def missed(self, messages: int) -> tuple[int, ...]:
        """How many numbers each jump left out, of those jumps that were due when this many messages had been sent."""
        due = [before for before in self.jumps if before <= messages]
        return tuple(self.sent[before].number - self.sent[before - 1].number - 1 for before in due)
