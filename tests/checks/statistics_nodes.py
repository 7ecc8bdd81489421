"""I1.2: fake statistics nodes, described by what they say and when."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

Log = tuple[int, str]
"""The level and the text of a log message."""

type Wording = str | Sequence[str | Log] | Callable[[FakeStats], Wording]
"""Templates of log messages: {count}, {rate}, {first}, ... stand for what the node has under that name."""

PLAIN = "count={count} rate={rate:.2f} first={first} last={last}"
SWAPPED = "{count} at {rate:.2f}/s, first message: '{last}', last message: '{first}'"
MISSING = "{missing} missing"


def true_rate(node: FakeStats) -> float:
    return node.count / max(node.elapsed_s, 1e-9)


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
    def elapsed_s(self) -> float:
        return self.times[-1] - self.begin

    @property
    def one_more(self) -> int:
        return self.count + 1

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
        if not self.takes(self):
            return
        fallen = self.number is not None and self.incoming < self.number
        if fallen and self.resets:
            yield from self._say(self.fall, level=30)
            self.count, self.first, self.number, self.restarts = 0, "", None, self.restarts + 1
        yield from self._say(self.heard)
        if not self.first:
            self.first, self.begin = data, now
        self.last = data
        self.times.append(now)
        self.messages.append(data)
        self.count += 1
        if self.number is not None and self.incoming not in (self.number, self.number + 1):
            yield from self._jump(fallen)
        self.number = self.incoming
        yield from self._say(self.counted)
        if self.due(self):
            yield from self.sum_up()

    def _jump(self, fallen: bool) -> Iterator[Log]:
        self.step, self.jumped_at = self.missing + 1, self.count
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


def one_line_per_value(node: FakeStats) -> list[str]:
    rate = f"Rate: {node.rate:.1f} Nachrichten/s".replace(".", ",")
    values = ["Anzahl: {count}", rate, "Erste: {first}", "Letzte: {last}"]
    return ["=" * 30, "Statistik", "-" * 30, *values, "=" * 30]


def with_clock(node: FakeStats) -> str:
    return (
        f"\x1b[32m2026-05-05 15:05:06,450 after 0:00:0{{elapsed_s:.6f}} ({{elapsed_s:.2f}} s, every {1 / node.rate:.3f}"
        " s) {count} x {rate:.2f}\x1b[0m {first} {last}"
    )


def now_and_then(node: FakeStats) -> Wording:
    if node.count == 0:
        return "first message: {data}"
    return "still alive after {one_more}" if node.count % 7 == 2 else ()


def noisy(node: FakeStats) -> Wording:
    return ["I heard: {data}", f"{len(node.data)} bytes, {{one_more}} so far"]


def first_overwritten(node: FakeStats) -> str:
    return f"count={{count}} rate={{rate:.2f}} first={node.messages[(node.count - 1) // 10 * 10]} last={{last}}"


class WarnsForEverAfterAGap(FakeStats):
    """Updates the last number only if there was no gap: after a jump, every message is a gap."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        before = self.number
        yield from super().receive(now, data)
        if before is not None and self.number is not None and self.number > before + 1:
            self.number = before


class SubscribedTwice(FakeStats):
    """Receives each message twice, through two subscriptions."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        yield from super().receive(now, data)
        yield from super().receive(now + 1e-4, data)


RIGHT = node()
GAP_BLIND = silent_about_gaps()
BLIND_AFTER_ZERO = node(gap=lambda node: MISSING if node.number else ())
SKIPS_THE_FIRST_GAP = node(gap=lambda node: MISSING if node.gaps > 1 else ())
COMPARES_TEXTS = node(
    heard=lambda node: [(30, "out of sequence")] if node.data < node.last else (), gap="out of sequence"
)
ONE_TOO_MANY = node(count=1)
ONE_TOO_FEW = node(count=-1, summary=lambda node: PLAIN if node.count else ())
N_AS_COUNT = node(summary="{number} at {rate:.2f}/s, {first} to {last}")
FIRST_OVERWRITTEN = node(summary=first_overwritten)
QUOTES_ALL = node(summary=PLAIN + " all={messages}")
QUOTES_THE_FIRST = saying_on_any_jump([(20, "since {first}: something is missing before Hello World: {incoming}")])
ONE_LINE_PER_VALUE = node(summary=one_line_per_value)
NOISY = node(heard=noisy)
