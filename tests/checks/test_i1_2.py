"""I1.2: made statistics nodes, fed by the clock of a test, and what must be said of each."""

from __future__ import annotations

import random
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from checks.i1_2 import CHECK, continuity, judges
from checks.i1_2.facts import (
    AGAIN_AFTER,
    FAST_HZ,
    FAST_MESSAGES,
    JUMP_AFTER,
    JUMP_MESSAGES,
    RESTART_AFTER,
    RESTART_MESSAGES,
    Sent,
    Trial,
)
from checks.i1_2.reading import read, values
from checks.i1_2.summaries import find_summaries
from tests.checks.made import (
    CRASH,
    NO_NODE,
    START,
    UP,
    assert_failed,
    assert_passed,
    assert_undecided,
    ending,
    exited,
    trace,
)
from tutor.judge.trace import LogRecord, Trace
from tutor.judge.verdict import Status, Verdict
from tutor.ros_model import TopicEndpoint

LISTENING = replace(UP, subscriptions=(TopicEndpoint("/chatter", "std_msgs/msg/String", "/node"),))
Log = tuple[int, str]
"""A level and a text."""


@dataclass
class Counter:
    """A statistics node without ROS: what it logs of each message. Wrong ones override what they do wrong."""

    every: int = 10
    total: int = 0
    first: str = ""
    last: str = ""
    begin: float = 0.0
    number: int | None = None
    missed: int = 0
    times: list[float] = field(default_factory=list)

    def take(self, now: float, data: str) -> Iterator[Log]:
        yield from self.heard(data)
        if not self.first:
            self.first, self.begin = data, now
        self.last = data
        self.times.append(now)
        self.total += 1
        number = int(data.split(":")[1])
        if self.number is not None and number != self.number + 1:
            yield from self.jumped(self.number, number)
        self.number = number
        if self.total % self.every == 0:
            yield from self.summary()

    def heard(self, data: str) -> Iterator[Log]:
        yield from ()

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        if number > last + 1:
            self.missed += number - last - 1
            yield 30, f"{number - last - 1} missing"

    def rate(self) -> float:
        return self.total / max(self.times[-1] - self.begin, 1e-9)

    def summary(self) -> Iterator[Log]:
        yield 20, f"count={self.total} rate={self.rate():.2f} first={self.first} last={self.last}"


def fed(
    node: Counter,
    numbers: Sequence[int],
    hz: float,
    *,
    breaks: int = 0,
    away_s: float = 0.0,
    late_s: float = 0.0005,
    slow_s: float = 0.0,
    between_s: float = 0.0002,
    more: Sequence[LogRecord] = (),
    **facts: object,
) -> Trial:
    """What is seen when messages with these numbers are sent to the node.

    `late_s`: until it logs something of one. `slow_s`: how much later the summaries come.
    """
    summaries: list[Log] = []
    summary = node.summary

    def noted() -> Iterator[Log]:
        summaries[:] = summary()
        yield from summaries

    node.summary = noted  # type: ignore[method-assign]
    sent: list[Sent] = []
    logs: list[LogRecord] = list(more)
    for index, number in enumerate(numbers):
        at = START + 1 + index / hz + (away_s if breaks and index >= breaks else 0.0)
        sent.append(Sent(number, at))
        summaries.clear()
        for order, log in enumerate(list(node.take(at + 0.0004, f"Hello World: {number}"))):
            stamp = at + late_s + order * between_s + slow_s * (log in summaries)
            logs.append(LogRecord(log[0], "node", log[1], stamp, stamp))
    gone_at = sent[breaks - 1].at + 0.2 if away_s else 0.0
    seen = Trial(trace(graph=LISTENING, logs=logs), tuple(sent), breaks, gone_at)
    return replace(seen, **facts)  # type: ignore[arg-type]


def steady(node: Counter, hz: float = 4.95, **more: object) -> Trial:
    return fed(node, range(20), hz, **more)  # type: ignore[arg-type]


def jump(node: Counter, missed: int = 5, *, first: int = 95, **more: object) -> Trial:
    numbers = list(range(first, first + JUMP_MESSAGES))
    numbers = [n + missed * (n >= numbers[JUMP_AFTER]) + (n >= numbers[AGAIN_AFTER]) for n in numbers]
    return fed(node, numbers, 8.0, breaks=JUMP_AFTER, again=AGAIN_AFTER, **more)  # type: ignore[arg-type]


def fast(node: Counter, **more: object) -> Trial:
    return fed(node, range(7, 7 + FAST_MESSAGES), FAST_HZ, **more)  # type: ignore[arg-type]


def restart(node: Counter, **more: object) -> Trial:
    numbers = [*range(4, 4 + RESTART_AFTER), *range(RESTART_MESSAGES - RESTART_AFTER)]
    return fed(node, numbers, 8.0, breaks=RESTART_AFTER, away_s=1.5, **more)  # type: ignore[arg-type]


def judged(make: Callable[[], Counter], **more: object) -> dict[str, Verdict]:
    """The verdicts on a node of which three are made."""
    even, jumped = steady(make(), **more), jump(make(), **more)  # type: ignore[arg-type]
    restarted, quick = restart(make(), **more), fast(make(), **more)
    count, summary = judges.judge_count(even, jumped, quick), judges.judge_summary(even, jumped, quick)
    for early, verdict in ((judges.judge_fast_count(quick), count), (judges.judge_fast_summary(quick), summary)):
        assert early is None or verdict.status is early.status is Status.FAILED
        assert early is None or early.cause.split(":")[0] == verdict.cause.split(":")[0]
    return {
        "count": count,
        "rate": judges.judge_rate(even, jumped),
        "summary": summary,
        "restart": continuity.judge_restart(restarted, even, jumped),
        "gaps": continuity.judge_gaps(jumped, even),
    }


def assert_all_passed(verdicts: dict[str, Verdict]) -> None:
    assert {name: str(v) for name, v in verdicts.items() if not v.passed} == {}
    for verdict in verdicts.values():
        assert_passed(verdict)


def assert_breaks(verdicts: dict[str, Verdict], criterion: str, cause: str) -> None:
    """It breaks this criterion for this cause, and no other."""
    assert_failed(verdicts[criterion], cause)
    others = {name: v for name, v in verdicts.items() if name != criterion}
    assert {name: str(v) for name, v in others.items() if v.status not in (Status.PASSED, Status.SKIPPED)} == {}


# Right ones, in the ways in which people write them.


class Restarting(Counter):
    """Starts again at zero when N falls, and says so."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        if self.number is not None and number < self.number:
            yield 30, "publisher restarted: counting from zero"
            self.total, self.first, self.number = 0, "", None
        yield from super().take(now, data)


class RestartsInTheSummary(Counter):
    """Starts again at zero, and says so in the next summary only."""

    restarts = 0

    def take(self, now: float, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        if self.number is not None and number < self.number:
            self.restarts += 1
            self.total, self.first, self.number = 0, "", None
        yield from super().take(now, data)

    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total}; {self.rate():.1f}; {self.first}; {self.last}; restarts {self.restarts}"


class GapCount(Counter):
    """Tells of gaps in the summary only: how many, and how many messages."""

    gaps = 0

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        if number > last + 1:
            self.gaps += 1
            self.missed += number - last - 1
        yield from ()

    def summary(self) -> Iterator[Log]:
        yield 20, self.line()

    def line(self) -> str:
        return f"{self.total} at {self.rate():.1f}/s, {self.gaps} gaps: {self.first} to {self.last}"


class MissedCount(GapCount):
    def line(self) -> str:
        return f"[{self.total}] [{self.rate():.1f}] [{self.missed}] [{self.first}] [{self.last}]"


class LossPercent(GapCount):
    def line(self) -> str:
        loss = 100 * self.missed / (self.missed + self.total)
        return f"{self.total} {self.rate():.1f} Hz {loss:.1f} % {self.first} {self.last}"


class LossShare(GapCount):
    def line(self) -> str:
        return (
            f"{self.total} {self.rate():.1f} Hz {self.missed / (self.missed + self.total):.3f} {self.first} {self.last}"
        )


class LargestStep(GapCount):
    """States the largest difference between two N, which is 1 where nothing is missing."""

    largest = 1

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        self.largest = max(self.largest, number - last)
        yield from ()

    def line(self) -> str:
        return f"n={self.total} hz={self.rate():.1f} largest step={self.largest} {self.first}..{self.last}"


class GapWords(GapCount):
    """No gap count, but other words."""

    def line(self) -> str:
        word = "complete" if not self.missed else "some are missing"
        return f"{self.total} messages, {word}, {self.rate():.1f}/s, {self.first} - {self.last}"


class GapAtTheStart(Counter):
    """Takes what it came too late for as a gap."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        if self.number is None:
            self.number = -1
        yield from super().take(now, data)


class Noisy(Counter):
    """Logs each message, and its bytes, and its own count."""

    def heard(self, data: str) -> Iterator[Log]:
        yield 20, f"I heard: {data}"
        yield 20, f"{len(data)} bytes, {self.total + 1} so far"


class OneLineEach(Counter):
    def summary(self) -> Iterator[Log]:
        yield 20, "=" * 30
        yield 20, "Statistik"
        yield 20, "-" * 30
        yield 20, f"Anzahl: {self.total}"
        yield 20, f"Rate: {self.rate():.1f} Nachrichten/s".replace(".", ",")
        yield 20, f"Erste: {self.first}"
        yield 20, f"Letzte: {self.last}"
        yield 20, "=" * 30


class LevelsMixed(OneLineEach):
    def summary(self) -> Iterator[Log]:
        for level, (_, text) in zip((20, 30, 40, 20, 50, 20, 30, 40), super().summary(), strict=True):
            yield level, text


class NoisyAndLong(Noisy, OneLineEach):
    pass


class LastSecond(Counter):
    def rate(self) -> float:
        return len([at for at in self.times if at > self.times[-1] - 1.0])


class LastTwoSeconds(Counter):
    def rate(self) -> float:
        return len([at for at in self.times if at > self.times[-1] - 2.0]) / min(2.0, self.times[-1] - self.begin)


class LastTen(Counter):
    def rate(self) -> float:
        recent = self.times[-10:]
        return len(recent) / (recent[-1] - recent[0])


class LastInterval(Counter):
    def rate(self) -> float:
        return 1 / (self.times[-1] - self.times[-2])


class Intervals(Counter):
    def rate(self) -> float:
        return (self.total - 1) / (self.times[-1] - self.begin)


class Rounded(Counter):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total} ({round(self.rate())} Hz) {self.first} {self.last}"


class Scientific(Counter):
    def summary(self) -> Iterator[Log]:
        yield 20, f"n: {self.total:e}, hz: {self.rate():e}, {self.first!r}, {self.last!r}"


class WithClock(Counter):
    """Puts the time of day, the elapsed time and the period into it, too."""

    def summary(self) -> Iterator[Log]:
        elapsed = self.times[-1] - self.begin
        yield (
            20,
            (
                f"\x1b[32m2026-05-05 15:05:06,450 after 0:00:0{elapsed:.6f} ({elapsed:.2f} s, "
                f"every {1 / self.rate():.3f} s)"
                f" {self.total} x {self.rate():.2f}\x1b[0m {self.first} {self.last}"
            ),
        )


class WithThousands(Counter):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total:,.1f} {self.rate() * 60:,.0f}/min {self.rate():,.3f}/s {self.first} {self.last}"


class Anniversary(Counter):
    """Other messages, now and then."""

    def heard(self, data: str) -> Iterator[Log]:
        if self.total == 0:
            yield 20, f"first message: {data}"
        if self.total % 7 == 2:
            yield 20, f"still alive after {self.total + 1}"


class Delivered(Counter):
    """No word of gaps: the share of what was sent that came."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        self.missed += max(0, number - last - 1)
        yield from ()

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} delivered={100 * self.total / (self.total + self.missed):.1f}%"


class OfExpected(Delivered):
    """How many messages there should have been, beside how many came."""

    def summary(self) -> Iterator[Log]:
        for level, text in Counter.summary(self):
            yield level, f"{text} ({self.total} of {self.total + self.missed})"


class LostSoFar(Delivered):
    """What is lost is told with each message, and nowhere else."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        said = list(super().take(now, data))
        yield 20, f"[{self.total}] {data}, lost so far: {self.missed}"
        yield from said

    def summary(self) -> Iterator[Log]:
        yield from Counter.summary(self)


class AllOfThem(Counter):
    """The summary quotes every message."""

    def __init__(self) -> None:
        super().__init__()
        self.all: list[str] = []

    def heard(self, data: str) -> Iterator[Log]:
        self.all.append(data)
        yield from ()

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} all={self.all}"


class NumbersItsRuns(Restarting):
    """The summary says which run it is of; nothing else tells of a restart."""

    run: int = 1

    def take(self, now: float, data: str) -> Iterator[Log]:
        self.run += self.number is not None and int(data.split(":")[1]) < self.number
        yield from (each for each in super().take(now, data) if "restarted" not in each[1])

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"run {self.run}: {text}"


class SinceTheLastSummary(GapCount):
    """Tells of what is missing since the last summary, and then starts again."""

    def line(self) -> str:
        missed, self.missed = self.missed, 0
        return f"{self.total} at {self.rate():.1f}/s, {missed} lost: {self.first} to {self.last}"


class GapsSinceTheLastSummary(GapCount):
    def line(self) -> str:
        gaps, self.gaps = self.gaps, 0
        return f"{self.total} at {self.rate():.1f}/s, {gaps} new gaps: {self.first} to {self.last}"


class LatestStep(LargestStep):
    """States how far N rose where it jumped last."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        self.largest = number - last
        yield from ()


class SinceTheLastGap(Counter):
    """Says, too, how many messages have come since the last gap, once there was one."""

    whole: int = -1

    def heard(self, data: str) -> Iterator[Log]:
        self.whole += self.whole >= 0
        yield from ()

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        self.whole = 1
        yield from super().jumped(last, number)

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} since the last gap: {self.whole}"


class QuotesBoth(Counter):
    """What it says of a jump quotes the message before and the one after, as a summary quotes two, too."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield 30, f"{number - last - 1} missing: Hello World: {last} -> Hello World: {number}"


class QuotesBothInThree(Counter):
    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield 30, "GAP!"
        yield 30, f"before: Hello World: {last}"
        yield 30, f"after: Hello World: {number}"


class QuotesTheFirst(Counter):
    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield 20, f"since {self.first}: something is missing before Hello World: {number}"


class RestartsAndQuotesBoth(Restarting):
    def take(self, now: float, data: str) -> Iterator[Log]:
        before = self.last
        for level, text in super().take(now, data):
            yield level, f"{before} -> {data}: counting from zero" if "restarted" in text else text


class QuotesBothAndChangesItsWords(QuotesBoth, GapWords):
    """After the jump, only what comes in time tells which are the summaries."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from QuotesBoth.jumped(self, last, number)
        yield from GapWords.jumped(self, last, number)


class LabelsElsewhere(Counter):
    """Has the words first and last before the other message each, but does not mean it."""

    def summary(self) -> Iterator[Log]:
        rate = f"{self.rate():.2f}"
        yield 20, f"{self.total} at {rate}/s, the last 10 messages: {self.first} (first) to {self.last} (last)"


class Row(GapCount):
    """A row of CSV."""

    def line(self) -> str:
        return f"{self.total},{self.rate():.2f},{self.missed},{self.first},{self.last}"


RIGHT = (
    LabelsElsewhere, Row,
    AllOfThem, Delivered, OfExpected, LostSoFar, NumbersItsRuns, Counter, Restarting, RestartsInTheSummary, GapCount,
    MissedCount, LossPercent, LossShare, LargestStep, GapWords, GapAtTheStart, Noisy, OneLineEach, LevelsMixed,
    NoisyAndLong, LastSecond, LastTwoSeconds, LastTen, LastInterval, Intervals, Rounded, Scientific, WithClock,
    WithThousands, Anniversary, QuotesBoth, QuotesBothInThree, QuotesTheFirst, RestartsAndQuotesBoth,
    QuotesBothAndChangesItsWords, SinceTheLastSummary, GapsSinceTheLastSummary, LatestStep, SinceTheLastGap,
)  # fmt: skip


@pytest.mark.parametrize("node", RIGHT)
@pytest.mark.parametrize("late_s", [0.0005, 0.03, 0.15, 0.3])
def test_right_ones(node: type[Counter], late_s: float) -> None:
    assert_all_passed(judged(node, late_s=late_s))


@pytest.mark.parametrize("node", RIGHT)
@pytest.mark.parametrize("slow_s", [0.3, 0.6, 0.9])
def test_summaries_by_a_slow_timer(node: type[Counter], slow_s: float) -> None:
    assert_all_passed(judged(node, slow_s=slow_s))


@pytest.mark.parametrize("between_s", [0.01, 0.04])
def test_a_summary_in_several_messages_may_take_its_time(between_s: float) -> None:
    assert_all_passed(judged(OneLineEach, between_s=between_s))


FORMATS = st.sampled_from([
    "{n} {r:.2f} {f} {l}", "{n} {r:.0f} {f} {l}", "{{'n': {n}, 'r': {r}, 'f': '{f}', 'l': '{l}'}}",
    "({n},{r:.2f},{f},{l})",
    "{f}|{l}|{n:05d}|{r:8.3f}", "n={n:.1f};r={r:.1f}/s;f={f};l={l}", "last: {l}\nfirst: {f}\nrate: {r}\ncount: {n}",
    "{n}件 毎秒{r:.1f}件 「{f}」「{l}」", "MessageStats(total_count={n}, first_message='{f}', last_message='{l}', "
    "start_time=1763726400.123, messages_per_second={r})", "#{n}: {r:g}Hz, «{f}» to «{l}»", "{n}/{r:.2f}/{f}/{l}",
    "ogółem {n}, {r:.2f} na sekundę, od {f} do {l}", "count............{n}\nrate.............{r:.2f}\n{f}\n{l}",
])  # fmt: skip


@settings(max_examples=100, deadline=None)
@given(
    written=FORMATS,
    hz=st.floats(4.9, 5.0),
    missed=st.integers(4, 8),
    seed=st.integers(0, 10_000),
    noisy=st.booleans(),
    late_s=st.floats(0.0005, 0.4),
    comma=st.booleans(),
)
def test_right_ones_in_any_format(
    written: str, hz: float, missed: int, seed: int, noisy: bool, late_s: float, comma: bool
) -> None:
    jitter = random.Random(seed)

    class Formatted(Noisy if noisy else Counter):  # type: ignore[misc]
        def take(self, now: float, data: str) -> Iterator[Log]:
            yield from super().take(now + jitter.uniform(0, 0.01), data)

        def summary(self) -> Iterator[Log]:
            text = written.format(n=self.total, r=self.rate(), f="F", l="L")
            text = text.replace(".", ",") if comma and "," not in text and "1763726400" not in text else text
            yield 20, text.replace("F", self.first).replace("L", self.last)

    even, jumped = steady(Formatted(), hz, late_s=late_s), jump(Formatted(), missed, late_s=late_s)
    assert_passed(judges.judge_slow_count(even, jumped))
    assert_passed(judges.judge_rate(even, jumped))
    assert_passed(judges.judge_slow_summary(even, jumped))
    assert_passed(continuity.judge_gaps(jumped, even))
    assert_passed(continuity.judge_restart(restart(Formatted(), late_s=late_s), even, jumped))


# Wrong ones.


def states(count: str = "{n}", rate: str = "{r:.2f}", first: str = "{f}", last: str = "{l}") -> type[Counter]:
    """A node that states this instead."""

    class Stating(Counter):
        def summary(self) -> Iterator[Log]:
            n, r, f, elapsed = self.total, self.rate(), self.first, self.times[-1] - self.begin
            number = self.number or 0
            known = {"n": n, "r": r, "f": f, "l": self.last, "e": elapsed, "number": number}
            known |= {
                "more": n + 1,
                "less": n - 1,
                "p": 1 / r,
                "m": 60 * r,
                "half": r / 2,
                "whole": n / int(elapsed + 1),
            }
            known |= {
                "since": n / (elapsed + 1.2),
                "off": 1.45 * r,
                "cut": n / max(1, int(elapsed)),
                "next": number + 1,
            }
            known |= {"received": n + self.missed, "kilo": r / 1000}
            yield 20, " | ".join(part.format(**known) for part in (count, rate, first, last))

    return Stating


STATES_WRONG = {
    "count: off by one": [states(count="{more}"), states(count="{less}")],
    "count: number taken for the count": [states(count="{number}"), states(count="{next}")],
    "count: missed messages counted": [states(count="{received}")],
    "count: wrong count": [states(count="1"), states(count="{half}"), states(count="10")],
    "rate: period instead of a rate": [states(rate="{p:.3f}")],
    "rate: rate per minute": [states(rate="{m:.1f}")],
    "rate: rate in another unit": [states(rate="{kilo:.6f}")],
    "rate: counted from the node's start": [states(rate="{since:.2f}")],
    "rate: wrong rate": [states(rate=each) for each in ("{half}", "{off}", "{e:.2f}", "1.0", "5.0", "0", "-{r:.2f}")],
    "rate: seconds cut off": [states(rate="{cut}")],
    "rate: no rate": [states(rate="?")],
    "summary: first message missing": [states(first="-")],
    "summary: last message missing": [states(last="-")],
    "summary: first message overwritten": [states(first="Hello World: 3")],
}  # fmt: skip


@pytest.mark.parametrize(
    ("breaks", "node"), [(breaks, node) for breaks, nodes in STATES_WRONG.items() for node in nodes]
)
def test_summaries_that_state_something_else(breaks: str, node: type[Counter]) -> None:
    criterion, cause = breaks.split(": ", 1)
    assert_breaks(judged(node), criterion, cause)


@pytest.mark.parametrize("wrong", [each for each in STATES_WRONG if each.startswith("rate: ")])
@pytest.mark.parametrize("late", [slice(0, 1), slice(1, 2)])
def test_what_is_wrong_with_the_rate_of_a_late_summary(wrong: str, late: slice) -> None:
    for node in STATES_WRONG[wrong]:
        even = steady(node())
        assert len(even.trace.logs) == 2
        logs = list(even.trace.logs)
        logs[late] = [replace(log, stamp=log.stamp + 0.25) for log in logs[late]]
        seen = replace(even, trace=replace(even.trace, logs=tuple(logs)))
        assert_failed(judges.judge_rate(seen, jump(node())), wrong.removeprefix("rate: "))


class LastIsTheHighest(Counter):
    """Takes the highest N for the last one, and after a restart N is low."""

    highest: int = -1

    def heard(self, data: str) -> Iterator[Log]:
        self.highest = max(self.highest, int(data.split(":")[1]))
        yield from ()

    def summary(self) -> Iterator[Log]:
        rate = self.rate()
        yield 20, f"{self.total} at {rate:.2f}, first={self.first} last=Hello World: {self.highest}"


class EachAfterRestart(Counter):
    """Sums up each message when N has fallen once."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from super().jumped(last, number)
        if number < last:
            self.every = 1


@dataclass
class HeldUp(EachAfterRestart):
    """The machine lets it run every third message of the new publisher only: it takes in three at once."""

    held: list[Log] = field(default_factory=list)

    def take(self, now: float, data: str) -> Iterator[Log]:
        logs = list(super().take(now, data))
        if self.every > 1:
            yield from logs
            return
        self.held.extend(logs)
        if self.total % 3 == 0:
            yield from self.held
            self.held.clear()


class ByASlowTimer(Counter):
    """A timer sums up, once there are ten messages more: the second time it is late."""

    summed: int = 0

    def heard(self, data: str) -> Iterator[Log]:
        if self.total // 10 > self.summed and (self.total > 23 or self.total < 20):
            self.summed = self.total // 10
            yield from super().summary()

    def summary(self) -> Iterator[Log]:
        yield from ()


def test_a_later_summary_may_wait_for_a_slow_timer() -> None:
    jumped = jump(ByASlowTimer())
    assert [summary.messages for summary in find_summaries(jumped)] == [11, 25, 31]
    assert_passed(judges.judge_slow_summary(steady(Counter()), jumped))
    assert_passed(judges.judge_slow_count(steady(Counter()), jumped))


class PerMinuteLater(Counter):
    """Its second summary states another rate than the first."""

    def rate(self) -> float:
        return super().rate() * (60 if self.total > 10 else 1)


class CountsFromOne(Counter):
    def take(self, now: float, data: str) -> Iterator[Log]:
        self.total = self.total or 1
        yield from super().take(now, data)


class ForgetsOne(Counter):
    """Says 10 when the eleventh message comes."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        self.total -= not self.first
        yield from super().take(now, data)

    def summary(self) -> Iterator[Log]:
        yield from super().summary() if self.total else ()


class Alarmed(Counter):
    """An alarm with each message."""

    def heard(self, data: str) -> Iterator[Log]:
        missing = int(data.split(":")[1]) - (self.number if self.number is not None else -1) - 1
        yield 30, f"{missing} missing"

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from ()


class AlarmedByTens(Counter):
    """Compares texts."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        if data < self.last:
            yield 30, "out of sequence"
        yield from super().take(now, data)

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        if number > last:
            yield 30, "out of sequence"


class GapBlind(Counter):
    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from ()


class GapBlindNoisy(GapBlind, NoisyAndLong):
    pass


class GapBlindAnniversary(GapBlind, Anniversary):
    pass


class GapBlindWithIds(GapBlind):
    def heard(self, data: str) -> Iterator[Log]:
        yield 20, f"message {hash(data) & 0xFFFFFF:07x} at 0x{id(data):x}"


class GapBlindRounded(GapBlind, Rounded):
    pass


class GapBlindWithClock(GapBlind, WithClock):
    pass


class GapCountStuck(GapBlind):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total} {self.rate()} gaps=0 restarts=0 {self.first} {self.last}"


class GapCountRising(GapBlind):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total} {self.rate()} gaps={self.total // 10} {self.first} {self.last}"


class LostForEver(GapCount):
    """What is lost goes on rising after a gap: each message is held against the number that was due once."""

    expected: int | None = None

    def heard(self, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        if self.expected is not None and number > self.expected:
            self.missed += number - self.expected
        self.expected = number + 1 if self.expected is None else self.expected + 1
        yield from ()

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from ()

    def line(self) -> str:
        return f"{self.total} at {self.rate():.1f}/s, {self.missed} lost: {self.first} to {self.last}"


class GapsForEver(LostForEver):
    """Counts each message after a gap as one more gap."""

    def line(self) -> str:
        self.gaps = self.missed and self.gaps + min(10, self.total - JUMP_AFTER)
        return f"{self.total} at {self.rate():.1f}/s, {self.gaps} gaps: {self.first} to {self.last}"


class LostForEverWithEachMessage(LostForEver):
    """Says so with each message, and not in the summary."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        yield from super().take(now, data)
        yield 20, f"{data}, lost so far: {self.missed}"

    def line(self) -> str:
        return f"{self.total} at {self.rate():.1f}/s: {self.first} to {self.last}"


class GapOnlyBack(Counter):
    def jumped(self, last: int, number: int) -> Iterator[Log]:
        if number < last:
            yield 30, "sequence went back"


class ToleratesOne(Counter):
    """One message may be missing."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        return super().jumped(last, number) if number > last + 2 else iter(())


class SkipsTheFirstGap(Counter):
    """Takes the first one for a false alarm."""

    alarms = 0

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        self.alarms += number > last + 1
        if self.alarms > 1:
            yield from super().jumped(last, number)


class OnlyTheFirstGap(Counter):
    def jumped(self, last: int, number: int) -> Iterator[Log]:
        return iter(()) if self.missed else super().jumped(last, number)


class LargestGapOnly(Counter):
    """Says so only where more is missing than ever before."""

    largest = 1

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        if number > last + self.largest:
            self.largest = number - last
            yield 30, f"{number - last - 1} missing"


class GapInTheNextSummaryOnce(GapCount):
    """Sets its gap count back, and does not count one again."""

    def line(self) -> str:
        gaps, self.gaps = self.gaps, -9
        return f"{self.total} at {self.rate():.1f}/s, {max(gaps, 0)} gaps: {self.first} to {self.last}"


class StopsAfterTwo(Counter):
    def summary(self) -> Iterator[Log]:
        if self.total <= 20:
            yield from super().summary()


class SilentReset(Restarting):
    def take(self, now: float, data: str) -> Iterator[Log]:
        yield from (log for log in super().take(now, data) if "restarted" not in log[1])


class DropsTheFirstAfterRestart(Restarting):
    """Starts over, and says so, but does not count the message that told it."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        fallen = self.number is not None and number < self.number
        yield from super().take(now, data)
        if fallen:
            self.total, self.first = 0, ""


class SilentResetWithGapCount(SilentReset):
    """The gap count stays what it is, and says nothing of a restart."""

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} gaps=0"


class TakesForRepeated(Counter):
    """Drops what has come before, as it thinks."""

    def __init__(self) -> None:
        super().__init__()
        self.seen: set[str] = set()

    def take(self, now: float, data: str) -> Iterator[Log]:
        if data not in self.seen:
            self.seen.add(data)
            yield from super().take(now, data)


class NeverGetsOverIt(Counter):
    """Keeps the last number only where there was no gap: from the jump on, each message is one."""

    level: int = 30

    def take(self, now: float, data: str) -> Iterator[Log]:
        before = self.number
        yield from super().take(now, data)
        if before is not None and self.number is not None and self.number > before + 1:
            self.number = before

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        for _, text in super().jumped(last, number):
            yield self.level, text


class NeverGetsOverItQuietly(NeverGetsOverIt):
    level: int = 20


class ResetsAtAGap(Counter):
    """A jump is not a restart: the total is no longer a total."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from super().jumped(last, number)
        if number > last:
            self.total = 1


class StopsAtAGap(Counter):
    """Says so, and sums up nothing more when numbers are missing."""

    stopped: bool = False

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from super().jumped(last, number)
        self.stopped = number > last

    def summary(self) -> Iterator[Log]:
        if not self.stopped:
            yield from super().summary()


class Twice(Counter):
    """Each summary comes twice."""

    def summary(self) -> Iterator[Log]:
        yield from super().summary()
        yield from super().summary()


class Polled(Counter):
    """A timer sums up whenever it finds a multiple of ten: three times until the next message."""

    def summary(self) -> Iterator[Log]:
        for times in range(3):
            for level, text in super().summary():
                yield level, f"{text} after {1.84 + 0.05 * times:.2f} s"


class Stubborn(Counter):
    """Drops what it takes for old."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        if self.number is None or int(data.split(":")[1]) > self.number:
            yield from super().take(now, data)


class CountsUpToN(Counter):
    """Takes N for the count after a restart."""

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        if number < last:
            self.total = 5
        yield from super().jumped(last, number)


class OnlyOnce(Counter):
    def summary(self) -> Iterator[Log]:
        if self.total == 10:
            yield from super().summary()


class TenLate(Counter):
    """Holds each summary back until the next one is due."""

    kept: tuple[Log, ...] = ()

    def summary(self) -> Iterator[Log]:
        yield from self.kept
        self.kept = tuple(super().summary())


class FirstOverwritten(Counter):
    def take(self, now: float, data: str) -> Iterator[Log]:
        if self.total and self.total % 10 == 0:
            self.first = data
        yield from super().take(now, data)


class Swapped(Counter):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total} at {self.rate():.2f}/s, first message: '{self.last}', last message: '{self.first}'"


class Behind(Counter):
    """Quotes the message before the last one."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        before = self.last
        for level, text in super().take(now, data):
            yield level, text.replace(f"last={data}", f"last={before}")


class TakesNForTheCount(Counter):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.number} at {self.rate():.2f}/s, {self.first} to {self.last}"


def test_a_wrong_total_shows_in_the_fast_stretch_already() -> None:
    for make, cause in ((CountsFromOne, "off by one"), (TakesNForTheCount, "number taken for the count")):
        early = judges.judge_fast_count(fast(make()))
        assert early is not None
        assert_failed(early, cause)


def test_summaries_that_are_too_many_or_incomplete_show_in_the_fast_stretch_already() -> None:
    cases: tuple[tuple[Callable[[], Counter], str], ...] = (
        (lambda: Counter(every=5), "too many summaries"),
        (FirstOverwritten, "first message overwritten"),
        (Swapped, "first and last swapped"),
    )
    for make, cause in cases:
        early = judges.judge_fast_summary(fast(make()))
        assert early is not None
        assert_failed(early, cause)


@pytest.mark.parametrize("make", [Counter, CountsFromOne, FirstOverwritten])
def test_a_stretch_that_was_not_fast_or_not_whole_shows_nothing_early(make: type[Counter]) -> None:
    slow = fed(make(), range(7, 7 + FAST_MESSAGES), FAST_HZ / 2)
    part = fed(make(), range(7, 7 + FAST_MESSAGES // 2), FAST_HZ)
    held_up = replace(fast(make()), cpu_wait_s=0.12)
    for seen in (slow, part, held_up):
        assert judges.judge_fast_count(seen) is None
        assert judges.judge_fast_summary(seen) is None


class AgainAfterASecond(Counter):
    """Writes each summary twice."""

    def summary(self) -> Iterator[Log]:
        yield from super().summary()

    def heard(self, data: str) -> Iterator[Log]:
        if self.total % 10 == 6 and self.total > 10:
            yield from super().summary()


@pytest.mark.parametrize(
    ("node", "criterion", "cause"),
    [
        (CountsFromOne, "count", "off by one"),
        (LastIsTheHighest, "restart", "last message missing"),
        (EachAfterRestart, "restart", "summary for every message"),
        (HeldUp, "restart", "summary for every message"),
        (PerMinuteLater, "rate", "rate per minute"),
        (Alarmed, "gaps", "gap not noticed"),
        (AlarmedByTens, "gaps", "false alarm"),
        *((node, "gaps", "gap not noticed") for node in (
            GapBlind, GapBlindNoisy, GapBlindAnniversary, GapBlindWithIds, GapBlindRounded, GapBlindWithClock,
            GapCountStuck, GapCountRising, GapOnlyBack, ToleratesOne, OnlyTheFirstGap, SkipsTheFirstGap, LargestGapOnly,
            GapInTheNextSummaryOnce,
        )),
        (SilentReset, "restart", "starts over silently"),
        (SilentResetWithGapCount, "restart", "starts over silently"),
        (TakesForRepeated, "restart", "stopped counting"),
        (Stubborn, "restart", "stopped counting"),
        (NeverGetsOverIt, "gaps", "false alarm"),
        (NeverGetsOverItQuietly, "gaps", "false alarm"),
        (LostForEver, "gaps", "false alarm"),
        (GapsForEver, "gaps", "false alarm"),
        (LostForEverWithEachMessage, "gaps", "false alarm"),
        (ResetsAtAGap, "count", "wrong count"),
        (StopsAtAGap, "summary", "missing summary"),
        (Twice, "summary", "too many summaries"),
        (Polled, "summary", "too many summaries"),
        (CountsUpToN, "restart", "wrong count after a restart"),
        (OnlyOnce, "summary", "missing summary"),
        (StopsAfterTwo, "summary", "missing summary"),
        (FirstOverwritten, "summary", "first message overwritten"),
        (Behind, "summary", "last message missing"),
        (Swapped, "summary", "first and last swapped"),
        (AgainAfterASecond, "summary", "too many summaries"),
        (lambda: Counter(every=5), "summary", "too many summaries"),
        (lambda: Counter(every=3), "summary", "too many summaries"),
        (lambda: Counter(every=2), "summary", "too many summaries"),
        (lambda: Counter(every=1), "summary", "summary for every message"),
        (lambda: Counter(every=9), "summary", "missing summary"),
        (lambda: Counter(every=11), "summary", "missing summary"),
        (lambda: Counter(every=20), "summary", "missing summary"),
        (TenLate, "summary", "missing summary"),
    ],
)  # fmt: skip
def test_wrong_ones(node: Callable[[], Counter], criterion: str, cause: str) -> None:
    verdicts = judged(node)
    if criterion == "summary" and cause == "missing summary":  # what comes at another time may state what it likes
        verdicts = {name: v for name, v in verdicts.items() if name in ("summary", "gaps")}
    if cause == "summary for every message":  # no time has passed at the first message
        verdicts.pop("rate")
    assert_breaks(verdicts, criterion, cause)


def test_a_late_summary_of_a_wrong_count_is_not_a_missing_one() -> None:
    even = steady(CountsFromOne())
    after_9, *others = even.trace.logs
    assert bisect_right([each.at for each in even.sent], after_9.stamp) == 9
    late = replace(after_9, stamp=even.sent[9].at + 0.01)
    seen = replace(even, trace=replace(even.trace, logs=(late, *others)))
    assert_failed(judges.judge_slow_count(seen, jump(CountsFromOne())), "off by one")
    verdict = judges.judge_slow_summary(seen, jump(CountsFromOne()))
    assert verdict.status is Status.SKIPPED, verdict


@pytest.mark.parametrize("late_s", [0.0005, 0.15, 0.24, 0.3])
def test_a_late_summary_with_an_older_last_message_counts_truly(late_s: float) -> None:
    assert_breaks(judged(Behind, late_s=late_s), "summary", "last message missing")


@pytest.mark.parametrize("late_s", [0.0005, 0.05, 0.1])
def test_a_node_that_drops_the_first_message_after_a_restart_counts_too_few(late_s: float) -> None:
    verdicts = judged(DropsTheFirstAfterRestart, late_s=late_s)
    assert_breaks(verdicts, "restart", "wrong count after a restart")


@pytest.mark.parametrize("late_s", [0.0005, 0.15, 0.24, 0.3])
def test_a_late_summary_with_a_newer_last_message_counts_too_few(late_s: float) -> None:
    verdict = judges.judge_slow_count(steady(ForgetsOne(), late_s=late_s), jump(ForgetsOne(), late_s=late_s))
    assert verdict.status is Status.FAILED, verdict


@pytest.mark.parametrize("cpu_wait_s", [0.0, 0.02, 2.0])
def test_what_tells_of_one_gap_does_not_tell_of_the_other(cpu_wait_s: float) -> None:
    jumped = jump(SkipsTheFirstGap(), cpu_wait_s=cpu_wait_s)
    assert_failed(continuity.judge_gaps(jumped, steady(SkipsTheFirstGap())), "gap not noticed")


@pytest.mark.parametrize(("text", "told"), [("2 gaps", True), ("6 numbers are missing", True), ("a gap", False)])
def test_one_message_tells_of_both_gaps_where_the_node_was_kept_from_running(text: str, told: bool) -> None:
    jumped, even = jump(Counter()), steady(Counter())
    logs = [log for log in jumped.trace.logs if "missing" not in log.text]
    assert len(logs) == len(jumped.trace.logs) - 2
    at = jumped.sent[AGAIN_AFTER].at + 0.1
    both = replace(jumped, trace=replace(jumped.trace, logs=(*logs, LogRecord(30, "node", text, at, at))))
    assert_failed(continuity.judge_gaps(both, even), "gap not noticed")
    verdict = continuity.judge_gaps(replace(both, cpu_wait_s=0.5), even)
    assert verdict.passed == told, verdict


@pytest.mark.parametrize("cpu_wait_s", [0.0, 2.0])
@pytest.mark.parametrize(("first", "late_s"), [(91, 0.0005), (92, 0.0005), (92, 0.124), (90, 0.0005)])
def test_an_alarm_beside_a_summary_is_none_of_its_lines(first: int, late_s: float, cpu_wait_s: float) -> None:
    jumped, even = jump(AlarmedByTens(), first=first), steady(AlarmedByTens())
    alarm = next(log for log in jumped.trace.logs if log.text == "out of sequence")
    stamp = alarm.stamp + late_s
    logs = [replace(log, stamp=stamp, received_at=stamp) if log is alarm else log for log in jumped.trace.logs]
    jumped = replace(jumped, trace=replace(jumped.trace, logs=tuple(logs)), cpu_wait_s=cpu_wait_s)
    assert_passed(judges.judge_slow_summary(even, jumped))
    assert_passed(judges.judge_slow_count(even, jumped))
    assert_failed(continuity.judge_gaps(jumped, even), "false alarm")


@settings(max_examples=50, deadline=None)
@given(
    written=st.sampled_from([
        "{n} {r:.2f} {f} {l}", "({n},{r:.1f},{f},{l})", "{f} {l}\n{r} Hz\n{n} messages"
    ]),
    by=st.sampled_from([-3, -2, -1, 1, 2, 3]),
    factor=st.one_of(st.floats(0.1, 0.7), st.floats(1.4, 9.0)),
    hz=st.floats(4.9, 5.0),
)  # fmt: skip
def test_a_wrong_number_is_found_in_any_format(written: str, by: int, factor: float, hz: float) -> None:
    class Wrong(Counter):
        def summary(self) -> Iterator[Log]:
            yield 20, written.format(n=self.total + off, r=self.rate() * scale, f=self.first, l=self.last)

    off, scale = by, 1.0
    assert judges.judge_slow_count(steady(Wrong(), hz), jump(Wrong())).status is Status.FAILED
    assert judges.judge_rate(steady(Wrong(), hz), jump(Wrong())).status is Status.PASSED
    off, scale = 0, factor
    assert judges.judge_slow_count(steady(Wrong(), hz), jump(Wrong())).status is Status.PASSED
    assert judges.judge_rate(steady(Wrong(), hz), jump(Wrong())).status is Status.FAILED


def test_a_gap_that_is_only_printed() -> None:
    jumped = jump(GapBlind())
    after = [line.replace("at", "at") for line in ("gap: 5 messages lost",)]
    printed = replace(jumped.trace, output=trace(out="\n".join(after)).output)
    printed = replace(printed, output=tuple(replace(line, at=jumped.sent[-1].at) for line in printed.output))
    assert_failed(
        continuity.judge_gaps(replace(jumped, trace=printed), steady(GapBlind())),
        "printed, not logged",
        "5 messages lost",
    )


# A node that is not there, or goes.


def silent(seen: Trace, **more: object) -> Verdict:
    even = replace(steady(Counter()), trace=seen, **more)  # type: ignore[arg-type]
    return judges.judge_slow_summary(even, even)


def test_why_there_is_no_summary() -> None:
    listening = trace(graph=LISTENING)
    assert_failed(silent(listening), "no summary")
    assert_failed(silent(listening, spins=False), "no spin")
    assert_failed(silent(NO_NODE, sent=()), "no node")
    assert_failed(silent(trace(), sent=()), "no subscription")
    assert_failed(silent(trace(graph=LISTENING, out="10 from Hello World: 0 to Hello World: 9")), "printed, not logged")
    assert_failed(silent(trace(graph=LISTENING, err=CRASH, exit=exited(1))), "unhandled exception", "line 12")
    written = "[INFO] [17.1] [stats]: 10 from Hello World: 0 to Hello World: 9"
    assert_failed(silent(trace(graph=LISTENING, err=written)), "not the node's logger")
    elsewhere = TopicEndpoint("/chatters", "std_msgs/msg/String", "/node")
    assert_failed(silent(trace(graph=replace(UP, subscriptions=(elsewhere,))), sent=()), "wrong topic")


def test_without_a_summary_nothing_else_is_judged() -> None:
    nothing = replace(steady(Counter()), trace=trace(graph=LISTENING))
    for verdict in (
        judges.judge_slow_count(nothing, nothing),
        judges.judge_rate(nothing, nothing),
        continuity.judge_restart(restart(Counter()), nothing, nothing),
        continuity.judge_gaps(nothing, nothing),
    ):
        assert verdict.status is Status.SKIPPED


def test_a_node_that_ends_when_the_publisher_goes_or_n_jumps() -> None:
    even, jumped, restarted = steady(Counter()), jump(Counter()), restart(Counter())
    ended = replace(restarted, trace=replace(restarted.trace, exit=exited(0, after_s=4)))
    assert_failed(continuity.judge_restart(ended, even, jumped), "exit at once")
    crashed = trace(graph=LISTENING, logs=jumped.trace.logs, err=CRASH, exit=exited(1))
    assert_failed(continuity.judge_gaps(replace(jumped, trace=crashed), even), "unhandled exception")
    deaf = replace(restarted, sent=restarted.sent[:RESTART_AFTER], trace=trace(logs=restarted.trace.logs))
    assert_failed(continuity.judge_restart(deaf, even, jumped), "no subscription")
    assert find_summaries(replace(deaf, trace=restarted.trace))[0].messages == 10


def test_shutdown() -> None:
    assert_passed(judges.judge_shutdown(replace(steady(Counter()), ending=ending())))
    assert_failed(judges.judge_shutdown(replace(steady(Counter()), ending=ending(still_there=True))), "SIGINT ignored")


# Messages that come fast.


class Naps(Counter):
    """Takes in ten messages a second at most: of what comes faster, it never hears the rest."""

    most_hz: float = 10.0

    def take(self, now: float, data: str) -> Iterator[Log]:
        if not self.times or now - self.times[-1] > 0.99 / self.most_hz:
            yield from super().take(now, data)

    def jumped(self, last: int, number: int) -> Iterator[Log]:
        yield from ()


class NapsALittle(Naps):
    most_hz: float = 16.0


class DropsTwo(Counter):
    """A queue of one, and a scheduler that was away for a moment."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        if data not in ("Hello World: 30", "Hello World: 31"):
            yield from super().take(now, data)


NAPS = """
while rclpy.ok():
    rclpy.spin_once(node, timeout_sec=0.1)
    time.sleep(0.1)
"""
SLEEPS = """
class Stats(Node):
    def __init__(self):
        self.create_subscription(String, 'chatter', self.heard, 10)
    def heard(self, msg):
        self.work(msg)
    def work(self, msg):
        time.sleep(0.2)
"""
SHORT = "node.create_subscription(String, 'chatter', heard, 1)"


def judged_fast(node: type[Counter], source: str = "", **more: object) -> Verdict:
    seen = fast(node(), **more)
    seen = replace(seen, trace=replace(seen.trace, sources={"node.py": source}))
    return judges.judge_count(steady(node()), jump(node()), seen)


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (NAPS, "nap between messages", "lines 2 to 4 become: rclpy.spin(node)"),
        (SLEEPS, "slow callback", "line 8 becomes: pass"),
        (SLEEPS.replace("self.heard,", "lambda msg: self.heard(msg),"), "slow callback", "line 8"),
        (SHORT, "queue too short", "10"),
        ("", "cannot keep up", "rclpy.spin(node)"),
    ],
)
def test_a_node_that_loses_messages_that_come_fast_is_told_why(source: str, cause: str, step: str) -> None:
    for node in (Naps, NapsALittle):
        assert_failed(judged_fast(node, source), cause, step)


@pytest.mark.parametrize("late_s", [0.0005, 0.1, 0.5, 1.0])
def test_a_node_that_loses_none_may_be_late(late_s: float) -> None:
    for node in (Counter, OneLineEach, Noisy, AllOfThem, QuotesTheFirst, DropsTwo):
        assert_passed(judged_fast(node, NAPS, late_s=late_s))


class Throttled(Counter):
    """Lets one summary through in that many seconds."""

    every_s: float = 1.0
    said_at: float = 0.0

    def take(self, now: float, data: str) -> Iterator[Log]:
        logs = list(super().take(now, data))
        if logs and now - self.said_at < self.every_s:
            return
        self.said_at = now if logs else self.said_at
        yield from logs


def test_a_summary_that_is_left_out_when_messages_come_fast_is_missing() -> None:
    source = "def heard(msg):\n    log.info('a',\n        throttle_duration_sec=1.0)\n"
    seen, even, jumped = fast(Throttled()), steady(Throttled()), jump(Counter())
    seen = replace(seen, trace=replace(seen.trace, sources={"node.py": source}))
    assert_passed(judges.judge_slow_summary(even, jumped))
    assert_failed(judges.judge_summary(even, jumped, seen), "log throttled", "lines 2 to 3 become: log.info('a')")
    plain = replace(seen, trace=replace(seen.trace, sources={}))
    assert_failed(judges.judge_summary(even, jumped, plain), "missing summary", "callback")
    assert_undecided(judges.judge_summary(even, jumped, replace(seen, cpu_wait_s=1.2)))


@pytest.mark.parametrize("late_s", [0.0005, 0.1, 0.5, 1.0])
def test_summaries_may_be_late_when_messages_come_fast(late_s: float) -> None:
    for node in (Counter, OneLineEach, Noisy, AllOfThem, QuotesTheFirst, DropsTwo):
        verdict = judges.judge_summary(steady(node()), jump(node()), fast(node(), late_s=late_s))
        assert verdict.passed == judges.judge_slow_summary(steady(node()), jump(node())).passed


def test_what_a_busy_machine_may_have_cost_is_not_a_verdict() -> None:
    assert_undecided(judged_fast(NapsALittle, cpu_wait_s=1.2))
    assert_failed(judged_fast(Naps, cpu_wait_s=0.2), "cannot keep up")
    assert_passed(judged_fast(Counter, cpu_wait_s=3.0))
    slowly = fed(Counter(), range(FAST_MESSAGES), 19.0)
    assert_undecided(judges.judge_count(steady(Counter()), jump(Counter()), slowly))
    assert_failed(judges.judge_count(steady(CountsFromOne()), jump(CountsFromOne()), slowly), "off by one")


# One cause behind several failures.

CHECKED = {criterion.id: criterion.judge for criterion in CHECK.criteria}
TWO_SUBSCRIPTIONS = """
self.one = self.create_subscription(String, 'chatter', self.heard, 10)

self.other = self.create_subscription(String, 'chatter', self.heard, 10)
"""


def checked(
    node: Callable[[], Counter], source: str = "", subscriptions: int = 1, *, late_s: float = 0.0005
) -> dict[str, Verdict]:
    """The verdicts as the check gives them, of a node with this source."""

    def of(seen: Trial) -> Trial:
        network = replace(LISTENING, subscriptions=subscriptions * LISTENING.subscriptions)
        return replace(seen, trace=replace(seen.trace, graph=network, sources={"node.py": source}))

    even, jumped = of(steady(node(), late_s=late_s)), of(jump(node(), late_s=late_s))
    restarted, quick = of(restart(node(), late_s=late_s)), of(fast(node(), late_s=late_s))
    return {
        "count": CHECKED["count"](even, jumped, quick),
        "rate": CHECKED["rate"](even, jumped),
        "summary": CHECKED["summary"](even, jumped, quick),
        "restart": CHECKED["restart"](restarted, even, jumped),
        "gaps": CHECKED["gaps"](jumped, even),
    }


class TakesTwice(Counter):
    """Has two subscriptions."""

    def take(self, now: float, data: str) -> Iterator[Log]:
        yield from super().take(now, data)
        yield from super().take(now + 1e-4, data)


def test_a_node_that_has_two_subscriptions_is_told_so_by_each_criterion() -> None:
    failures = {n: v for n, v in checked(TakesTwice, TWO_SUBSCRIPTIONS, 2).items() if v.status is Status.FAILED}
    assert len(failures) >= 2
    for verdict in failures.values():
        assert_failed(verdict, "two subscriptions", "lines 2 and 4", "remove line 4: self.other")


def test_a_node_that_counts_twice_with_one_subscription_or_once_with_two_is_told_of_something_else() -> None:
    for verdict in (
        *checked(TakesTwice, TWO_SUBSCRIPTIONS, 1).values(),
        *checked(CountsFromOne, TWO_SUBSCRIPTIONS, 2).values(),
    ):
        assert "two subscriptions" not in verdict.cause


def test_a_node_that_is_kept_waiting_by_its_own_sleep_is_told_so_by_each_criterion() -> None:
    failures = {n: v for n, v in checked(Counter, SLEEPS, late_s=1.6).items() if v.status is Status.FAILED}
    assert len(failures) >= 1
    for verdict in failures.values():
        assert_failed(verdict, "slow callback", "line 8 becomes: pass")


def test_a_nap_in_a_loop_that_waits_is_not_what_keeps_the_callback() -> None:
    waits = SLEEPS.replace("        time.sleep", "        while not self.total: time.sleep")
    assert not any("slow callback" in verdict.cause for verdict in checked(Counter, waits, late_s=1.6).values())


def test_a_node_that_sleeps_but_keeps_up_is_told_what_else_is_wrong() -> None:
    for node in (CountsFromOne, FirstOverwritten, GapBlind, OneLineEach):
        assert not any("slow" in verdict.cause for verdict in checked(node, SLEEPS).values())


# A busy machine.


def test_a_node_that_took_in_the_first_message_late_measured_a_higher_rate() -> None:
    """Half a second late, as far as the kernel says: then 10 messages came in 1.3 s."""

    class Late(Counter):
        def rate(self) -> float:
            return self.total / (self.times[-1] - self.begin - 0.5)

    even = steady(Late())
    owed = [0.0, 0.25, *[0.5] * 18]
    excused = tuple(replace(each, cpu_wait_s=late) for each, late in zip(even.sent, owed, strict=True))
    assert_failed(judges.judge_rate(even, jump(Late())), "wrong rate")
    assert_passed(judges.judge_rate(replace(even, sent=excused, cpu_wait_s=0.5), jump(Late())))


def test_a_pace_at_which_the_seconds_seem_to_be_the_rate_is_not_a_pace_to_judge_by() -> None:
    cut = states(rate="{cut}")
    assert_undecided(judges.judge_rate(steady(cut(), 4.4), jump(cut())))
    assert_passed(judges.judge_rate(steady(Counter(), 4.4), jump(Counter())))


# Reading.


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("10", 10), ("4.93", 4.93), ("4,93", 4.93), ("4,93", 93), ("1,234.5", 1234.5), ("1.234,5", 1234.5),
        ("1'234", 1234),
        ("1_234", 1234), ("-4.93", -4.93), ("1e1", 10), ("4.9e+00", 4.9), ("10,4.93", 10), ("10,4.93", 4.93),
        ("1.2.3", 2),
        ("007", 7), ("1,234", 1.234), ("1,234", 1234),
    ],
)  # fmt: skip
def test_what_a_number_may_mean(written: str, meant: float) -> None:
    assert meant in list(values(written))


def said(text: str) -> tuple[str, ...]:
    return tuple(number.text for number in read(LogRecord(20, "node", text, START, START), 1).numbers)


def test_what_is_a_number_and_what_is_not() -> None:
    assert said("10 of “Hello World: 12” at 15:04:05 on 2026-05-05") == ("10",)
    assert said("\x1b[31m7\x1b[0m apples, -3 pears, 2-3 plums, \uff15") == ("7", "-3", "2", "3", "5")
    assert said("合計10件") == ("10",)
    assert said("no number at all") == ()
    assert said("10'5 and 1_2") == ("10", "5", "1", "2")


def test_a_list_without_blanks_is_several_numbers() -> None:
    numbers = read(LogRecord(20, "node", "20,4.95,5,Hello World: 0", START, START), 1).numbers
    assert [number.values for number in numbers] == [(20,), (4.95,), (5,)]
    numbers = read(LogRecord(20, "node", "10,4,93,0", START, START), 1).numbers
    assert [number.value for number in numbers] == [10, 4, 93, 0]
    assert 4.93 in numbers[1].values
    assert said("1,234.5 of 1.234,5") == ("1,234.5", "1.234,5")


@given(st.text(alphabet="0123456789.,'_-+eE \u2212\u2019\u202f\u00a0"))
def test_any_text_can_be_read(text: str) -> None:
    assert all(number.values for number in read(LogRecord(20, "node", text, START, START), 1).numbers)


def test_messages_of_one_wording_are_of_one_kind() -> None:
    one, other = (
        read(LogRecord(20, "node", text, START, START), 1)
        for text in ("got   Hello World: 9, 1 of 3 ###", "got Hello World: 10,  12.5 of -4 #####")
    )
    assert one.kind == other.kind
    assert (one.quoted, other.quoted) == ((9,), (10,))


def test_an_alarm_beside_a_summary_is_no_part_of_the_next_one() -> None:
    class Beside(Counter):
        def heard(self, data: str) -> Iterator[Log]:
            if self.total == 10:
                yield 30, "by the way: 3"

    assert [summary.messages for summary in find_summaries(steady(Beside()))] == [10, 20]
    assert [len(summary.lines) for summary in find_summaries(steady(Beside()))] == [1, 1]


def test_what_is_said_just_before_a_summary_is_due_is_no_part_of_it() -> None:
    jumped = jump(Counter())
    early = jumped.sent[29].at - 0.01
    logs = (*jumped.trace.logs, LogRecord(40, "node", "1 lost in the last second", early, early))
    jumped = replace(jumped, trace=replace(jumped.trace, logs=logs))
    assert [summary.messages for summary in find_summaries(jumped)] == [10, 20, 30]


def test_how_much_later_than_due_a_message_was_sent() -> None:
    even = steady(Counter())
    late = replace(even, sent=tuple(replace(each, at=each.at + 0.4 * (each.number > 12)) for each in even.sent))
    assert even.most_late_s == pytest.approx(0.0, abs=1e-6)
    assert late.most_late_s == pytest.approx(0.4, abs=1e-3)
    assert restart(Counter()).most_late_s == pytest.approx(0.0, abs=1e-6), "a publisher that is away is none"
    assert Trial(trace()).most_late_s == 0.0
