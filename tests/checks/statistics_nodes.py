"""I1.2: fake statistics nodes, described by what they say and when."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from checks.i1_2_message_statistics.plans import JUMP_AFTER

Log = tuple[int, str]
"""The level and the text of a log message."""

type Wording = str | Sequence[str | Log] | Callable[[FakeStats], Wording]
"""Templates of log messages: {count}, {rate}, {first}, ... stand for what the node has under that name."""

PLAIN = "count={count} rate={rate:.2f} first={first} last={last}"
MISSING = "{missing} missing"
GAPS = "{count} at {rate:.1f}/s, {gaps} gaps: {first} to {last}"
LOST = "{count} at {rate:.1f}/s, {missed} lost: {first} to {last}"


def true_rate(node: FakeStats) -> float:
    return node.count / max(node.times[-1] - node.begin, 1e-9)


@dataclass
class FakeStats:
    """A statistics node without ROS: yields what it logs for each message. By default, it is right.

    `heard`: said before a message is counted; `counted`: said afterwards. `gap`, `fall`: said if N rises by more than
    one, or falls. `due`: whether to sum up. `takes`: whether it receives the message at all. `resets`: whether it
    starts over when N falls. `at_gap`, `at_fall`, `at_summary`: what it then sets its variables to.
    """

    summary: Wording = PLAIN
    heard: Wording = ()
    counted: Wording = ()
    gap: Wording = MISSING
    fall: Wording = ()
    rating: Callable[[FakeStats], float] = true_rate
    due: Callable[[FakeStats], bool] = lambda node: node.count % node.every == 0
    takes: Callable[[FakeStats], bool] = lambda node: True
    resets: bool = False
    at_gap: Mapping[str, int] = field(default_factory=dict)
    at_fall: Mapping[str, int] = field(default_factory=dict)
    at_summary: Mapping[str, int] = field(default_factory=dict)
    every: int = 10
    count: int = 0
    first: str = ""
    last: str = ""
    number: int | None = None
    missed: int = 0
    gaps: int = 0
    step: int = 1
    largest: int = 1
    jumped_at: int = 0
    restarts: int = 0
    begin: float = 0.0
    now: float = 0.0
    data: str = ""
    incoming: int = 0
    times: list[float] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)

    @property
    def rate(self) -> float:
        return self.rating(self)

    @property
    def one_more(self) -> int:
        return self.count + 1

    @property
    def one_less(self) -> int:
        return self.count - 1

    @property
    def expected(self) -> int:
        return self.count + self.missed

    @property
    def missing(self) -> int:
        """How many numbers are left out before this message."""
        return self.incoming - (-1 if self.number is None else self.number) - 1

    @property
    def numbers(self) -> list[int]:
        return [int(message.split(":")[1]) for message in self.messages]

    def __getitem__(self, name: str) -> object:
        return getattr(self, name)

    def receive(self, now: float, data: str) -> Iterator[Log]:
        self.now, self.data, self.incoming = now, data, int(data.split(":")[1])
        if self.takes(self):
            yield from self._take()

    def _take(self) -> Iterator[Log]:
        fallen = self.number is not None and self.incoming < self.number
        if fallen and self.resets:
            yield from self._say(self.fall, level=30)
            self.count, self.first, self.number, self.restarts = 0, "", None, self.restarts + 1
        yield from self._say(self.heard)
        if not self.first:
            self.first, self.begin = self.data, self.now
        self.last = self.data
        self.times.append(self.now)
        self.messages.append(self.data)
        self.count += 1
        if self.number is not None and self.incoming not in (self.number, self.number + 1):
            yield from self._jump(fallen)
        self.number = self.incoming
        yield from self._say(self.counted)
        if self.due(self):
            yield from self.sum_up()

    def _jump(self, fallen: bool) -> Iterator[Log]:
        assert self.number is not None
        self.step, self.jumped_at = self.incoming - self.number, self.count
        self.largest = max(self.largest, self.step)
        if not fallen:
            self.gaps, self.missed = self.gaps + 1, self.missed + self.missing
        yield from self._say(self.fall if fallen else self.gap, level=30)
        vars(self).update(self.at_fall if fallen else self.at_gap)

    def sum_up(self) -> Iterator[Log]:
        yield from self._say(self.summary)
        vars(self).update(self.at_summary)

    def _say(self, wording: Wording, level: int = 20) -> Iterator[Log]:
        if callable(wording):
            yield from self._say(wording(self), level)
            return
        for text in [wording] if isinstance(wording, str) else wording:
            level_of, template = (level, text) if isinstance(text, str) else text
            yield level_of, template.format_map(self)


Make = Callable[[], FakeStats]


def node(of: type[FakeStats] = FakeStats, **what: Any) -> Make:
    """A node that differs from a right one in this (see `FakeStats`)."""
    return partial(of, **what)


def silent_about_gaps(summary: Wording = PLAIN, **what: Any) -> Make:
    """A node that says nothing when N jumps; its summaries may."""
    return node(summary=summary, gap=(), **what)


def saying_on_any_jump(text: Wording, **what: Any) -> Make:
    return node(gap=text, fall=text, **what)


def restarting(fall: Wording = "publisher restarted: counting from zero", **what: Any) -> Make:
    return node(resets=True, fall=fall, **what)


def receiving(takes: Callable[[FakeStats], bool], **what: Any) -> Make:
    """A node that loses all other messages."""
    return node(takes=takes, **what)


def one_line_per_value(node: FakeStats) -> list[str]:
    rate = f"Rate: {node.rate:.1f} Nachrichten/s".replace(".", ",")
    values = ["Anzahl: {count}", rate, "Erste: {first}", "Letzte: {last}"]
    return ["=" * 30, "Statistik", "-" * 30, *values, "=" * 30]


def with_clock(node: FakeStats) -> str:
    elapsed_s = node.times[-1] - node.begin
    return (
        f"\x1b[32m2026-05-05 15:05:06,450 after 0:00:0{elapsed_s:.6f} ({elapsed_s:.2f} s, every {1 / node.rate:.3f} s)"
        " {count} x {rate:.2f}\x1b[0m {first} {last}"
    )


def complete_or_not(node: FakeStats) -> str:
    word = "some are missing" if node.missed else "complete"
    return f"{{count}} messages, {word}, {{rate:.1f}}/s, {{first}} - {{last}}"


def now_and_then(node: FakeStats) -> Wording:
    if node.count == 0:
        return "first message: {data}"
    return "still alive after {one_more}" if node.count % 7 == 2 else ()


def noisy(node: FakeStats) -> Wording:
    return ["I heard: {data}", f"{len(node.data)} bytes, {{one_more}} so far"]


def lost_for_ever(node: FakeStats) -> int:
    """What a node counts as lost whose expected number never catches up after a gap."""
    first = node.numbers[0]
    return sum(max(0, number - first - index) for index, number in enumerate(node.numbers))


def loss_keeps_rising(node: FakeStats) -> str:
    return f"{{count}} at {{rate:.1f}}/s, {lost_for_ever(node)} lost: {{first}} to {{last}}"


def gaps_keep_rising(node: FakeStats) -> str:
    gaps = node.count - JUMP_AFTER if lost_for_ever(node) else 0
    return f"{{count}} at {{rate:.1f}}/s, {gaps} gaps: {{first}} to {{last}}"


class WarnsForEverAfterAGap(FakeStats):
    """Updates the last number only if there was no gap: after a jump, every message is a gap."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        before = self.number
        yield from super().receive(now, data)
        if before is not None and self.number is not None and self.number > before + 1:
            self.number = before


class DropsTheFirstAfterRestart(FakeStats):
    """Resets its count and logs that, but does not count the message that revealed the restart."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        restarts = self.restarts
        yield from super().receive(now, data)
        if self.restarts > restarts:
            self.count, self.first = 0, ""


class EachSummaryTenLate(FakeStats):
    """Holds each summary back until the next one is due."""

    kept: tuple[Log, ...] = ()

    def sum_up(self) -> Iterator[Log]:
        yield from self.kept
        self.kept = tuple(super().sum_up())


class BoundedList(FakeStats):
    """Counts what is in a list of at most 20 messages, so that from the 20th on every message brings a summary."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        self.count = min(self.count, 19)
        yield from super().receive(now, data)


class SubscribedTwice(FakeStats):
    """Receives each message twice, through two subscriptions."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        yield from super().receive(now, data)
        yield from super().receive(now + 1e-4, data)


@dataclass
class StarvedAfterRestart(FakeStats):
    """A busy machine lets it run only at every third message of the new publisher: it receives three at once."""

    held: list[Log] = field(default_factory=list)

    def receive(self, now: float, data: str) -> Iterator[Log]:
        logs = list(super().receive(now, data))
        if self.every > 1:
            yield from logs
            return
        self.held.extend(logs)
        if self.count % 3 == 0:
            yield from self.held
            self.held.clear()


class Throttled(FakeStats):
    """Logs at most once a second."""

    said_at: float = 0.0

    def receive(self, now: float, data: str) -> Iterator[Log]:
        logs = list(super().receive(now, data))
        if not logs or now - self.said_at >= 1.0:
            self.said_at = now if logs else self.said_at
            yield from logs


RIGHT = FakeStats
GAP_BLIND = silent_about_gaps()
ONE_TOO_MANY = node(count=1)
ONE_TOO_FEW = node(count=-1, summary=lambda node: PLAIN if node.count else ())
FIRST_OVERWRITTEN = node(
    summary=lambda node: (
        f"count={{count}} rate={{rate:.2f}} first={node.messages[(node.count - 1) // 10 * 10]} last={{last}}"
    )
)
QUOTES_ALL = node(summary=PLAIN + " all={messages}")
QUOTES_THE_FIRST = saying_on_any_jump([(20, "since {first}: something is missing before Hello World: {incoming}")])
ONE_LINE_PER_VALUE = node(summary=one_line_per_value)
NOISY = node(heard=noisy)
LOSES_TWO = receiving(lambda node: node.incoming not in (30, 31))
