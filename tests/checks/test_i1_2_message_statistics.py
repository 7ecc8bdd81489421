"""I1.2: verdicts on fake statistics nodes that are fed messages on a simulated clock."""

from __future__ import annotations

import random
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from checks.i1_2_message_statistics import CHECK
from checks.i1_2_message_statistics.count import in_words, judge_count, judge_fast_count
from checks.i1_2_message_statistics.feeding import logs_something_new
from checks.i1_2_message_statistics.gaps import judge_gaps, judge_jumps
from checks.i1_2_message_statistics.log_lines import parse_log, values
from checks.i1_2_message_statistics.logged_summaries import find_summaries
from checks.i1_2_message_statistics.plans import (
    AFTER_ZERO_MESSAGES,
    FAST_HZ,
    FAST_MESSAGES,
    FIRST_NUMBERS,
    JUMP_AFTER,
    JUMP_MESSAGES,
    LEFT_OUT,
    RESTART_AFTER,
    RESTART_MESSAGES,
    SECOND_JUMP_AFTER,
)
from checks.i1_2_message_statistics.rate import judge_rate
from checks.i1_2_message_statistics.restart import judge_restart
from checks.i1_2_message_statistics.summary import judge_fast_summary, judge_slow_summary, judge_summary
from checks.i1_2_message_statistics.trial import Sent, Trial
from tests.checks.builders import (
    CRASH,
    FOLDER,
    NO_NODE,
    NODE_UP,
    START,
    assert_passed,
    assert_undecided,
    ending,
    exited,
    explained,
    trace,
)
from tests.checks.builders import assert_failed as assert_explained
from tutor.judge.trace import LogRecord, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Status, Verdict
from tutor.ros_model import TopicEndpoint


def explain(verdict: Verdict) -> Verdict:
    """The verdict with the mistake that explains it, if it is a failure."""
    return explained(verdict, CHECK)


def assert_failed(verdict: Verdict | None, cause: str, *words: str) -> None:
    """Fail unless the verdict failed, and the catalogue explains it by this mistake, with these words."""
    assert_explained(verdict, cause, *words, check=CHECK)


LISTENING = replace(NODE_UP, subscriptions=(TopicEndpoint("/chatter", "std_msgs/msg/String", "/node"),))
Log = tuple[int, str]
"""The level and the text of a log message."""


@dataclass
class FakeStats:
    """A statistics node without ROS: yields what it logs for each message. Faulty ones override what they get wrong."""

    every: int = 10
    total: int = 0
    first: str = ""
    last: str = ""
    begin: float = 0.0
    number: int | None = None
    missed: int = 0
    times: list[float] = field(default_factory=list)

    def receive(self, now: float, data: str) -> Iterator[Log]:
        yield from self.log_received(data)
        if not self.first:
            self.first, self.begin = data, now
        self.last = data
        self.times.append(now)
        self.total += 1
        number = int(data.split(":")[1])
        if self.number is not None and number != self.number + 1:
            yield from self.on_jump(self.number, number)
        self.number = number
        if self.total % self.every == 0:
            yield from self.summary()

    def log_received(self, data: str) -> Iterator[Log]:
        yield from ()

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        if number > last + 1:
            self.missed += number - last - 1
            yield 30, f"{number - last - 1} missing"

    def rate(self) -> float:
        return self.total / max(self.times[-1] - self.begin, 1e-9)

    def summary(self) -> Iterator[Log]:
        yield 20, f"count={self.total} rate={self.rate():.2f} first={self.first} last={self.last}"


def feed(
    node: FakeStats,
    numbers: Sequence[int],
    hz: float,
    *,
    breaks: tuple[int, ...] = (),
    away_s: float = 0.0,
    late_s: float = 0.0005,
    slow_s: float = 0.0,
    between_s: float = 0.0002,
    more: Sequence[LogRecord] = (),
    **facts: object,
) -> Trial:
    """The trial that is observed when messages with these numbers are sent to the node.

    `breaks`: indexes of the first messages after a jump or restart, before the first of which the publisher is away for
    `away_s`. `late_s`: delay from a message to its first log message. `between_s`: delay between two log messages of
    one message. `slow_s`: further delay of the summaries.
    """
    summaries: list[Log] = []
    summary = node.summary

    def record_summary() -> Iterator[Log]:
        summaries[:] = summary()
        yield from summaries

    node.summary = record_summary  # type: ignore[method-assign]
    sent: list[Sent] = []
    logs: list[LogRecord] = list(more)
    for index, number in enumerate(numbers):
        at = START + 1 + index / hz + (away_s if breaks and index >= breaks[0] else 0.0)
        sent.append(Sent(number, at))
        summaries.clear()
        for order, log in enumerate(list(node.receive(at + 0.0004, f"Hello World: {number}"))):
            stamp = at + late_s + order * between_s + slow_s * (log in summaries)
            logs.append(LogRecord(log[0], "node", log[1], stamp, stamp))
    gone_at = sent[breaks[0] - 1].at + 0.2 if away_s else 0.0
    seen = Trial(trace(graph=LISTENING, logs=logs), tuple(sent), breaks, gone_at)
    return replace(seen, **facts)  # type: ignore[arg-type]


def steady(node: FakeStats, hz: float = 4.95, **more: object) -> Trial:
    return feed(node, range(20), hz, **more)  # type: ignore[arg-type]


def jump(node: FakeStats, missed: int = LEFT_OUT[0], *, first: int = 95, twice: bool = False, **more: object) -> Trial:
    numbers = list(range(first, first + JUMP_MESSAGES))
    breaks = (JUMP_AFTER, SECOND_JUMP_AFTER) if twice else (JUMP_AFTER,)
    numbers = [n + missed * (n >= numbers[JUMP_AFTER]) + (twice and n >= numbers[SECOND_JUMP_AFTER]) for n in numbers]
    return feed(node, numbers, 8.0, breaks=breaks, **more)  # type: ignore[arg-type]


def jump_twice(node: FakeStats, missed: int = LEFT_OUT[0], *, first: int = 95, **more: object) -> Trial:
    return jump(node, missed, first=first, twice=True, **more)


def jump_after_zero(node: FakeStats, missed: int = LEFT_OUT[0], **more: object) -> Trial:
    numbers = [0, *range(missed + 1, missed + AFTER_ZERO_MESSAGES)]
    return feed(node, numbers, 8.0, breaks=(1,), **more)  # type: ignore[arg-type]


def fast(node: FakeStats, **more: object) -> Trial:
    return feed(node, range(7, 7 + FAST_MESSAGES), FAST_HZ, **more)  # type: ignore[arg-type]


def restart(node: FakeStats, **more: object) -> Trial:
    numbers = [*range(4, 4 + RESTART_AFTER), *range(RESTART_MESSAGES - RESTART_AFTER)]
    return feed(node, numbers, 8.0, breaks=(RESTART_AFTER,), away_s=1.5, **more)  # type: ignore[arg-type]


NOTHING = Trial(trace())
"""A trial in which nothing was sent, for judges that are to judge by the others."""


def judge_slow_count(steady: Trial, jump: Trial) -> Verdict:
    return judge_count(steady, jump, NOTHING)


def judge_stated_rate(steady: Trial, jump: Trial, restart: Trial = NOTHING) -> Verdict:
    return judge_rate(steady, jump, restart, NOTHING)


def judge_new_publisher(restart: Trial, steady: Trial, jump: Trial) -> Verdict:
    return judge_restart(steady, jump, restart, NOTHING)


def judge_rising(jump: Trial, jump_twice: Trial, steady: Trial) -> Verdict:
    return judge_gaps(steady, jump, jump_twice, NOTHING, NOTHING, NOTHING)


def judge_trials(make: Callable[[], FakeStats], **more: object) -> dict[str, Verdict]:
    """The verdicts on such a node, with a fresh one for each trial."""
    steady_trial, jump_trial = steady(make(), **more), jump(make(), **more)  # type: ignore[arg-type]
    twice_trial = jump_twice(make(), **more)  # type: ignore[arg-type]
    restart_trial, fast_trial = restart(make(), **more), fast(make(), **more)
    count = judge_count(steady_trial, jump_trial, fast_trial)
    summary = judge_summary(steady_trial, jump_trial, fast_trial)
    zero_trial = jump_after_zero(make(), **more)  # type: ignore[arg-type]
    gaps = judge_gaps(steady_trial, jump_trial, twice_trial, zero_trial, restart_trial, fast_trial)
    early_count, early_summary = judge_fast_count(fast_trial), judge_fast_summary(fast_trial)
    for early, verdict in ((early_count, count), (early_summary, summary)):
        assert early is None or verdict.status is early.status is Status.FAILED
        assert early is None or explain(early).mistake == explain(verdict).mistake
    verdicts = {
        "count": count,
        "rate": judge_stated_rate(steady_trial, jump_trial),
        "summary": summary,
        "restart": judge_restart(steady_trial, jump_trial, restart_trial, fast_trial),
        "gaps": gaps,
    }
    return {name: explain(verdict) for name, verdict in verdicts.items()}


def assert_all_passed(verdicts: dict[str, Verdict]) -> None:
    assert {name: str(v) for name, v in verdicts.items() if not v.passed} == {}
    for verdict in verdicts.values():
        assert_passed(verdict)


def assert_breaks(verdicts: dict[str, Verdict], criterion: str, cause: str) -> None:
    """Fail unless this criterion failed with this cause, and no other criterion failed."""
    assert_failed(verdicts[criterion], cause)
    others = {name: v for name, v in verdicts.items() if name != criterion}
    assert {name: str(v) for name, v in others.items() if v.status not in (Status.PASSED, Status.SKIPPED)} == {}


# Correct nodes, in the ways in which people write them.


class Restarting(FakeStats):
    """Resets its count when N falls, and logs that."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        if self.number is not None and number < self.number:
            yield 30, "publisher restarted: counting from zero"
            self.total, self.first, self.number = 0, "", None
        yield from super().receive(now, data)


class RestartsInTheSummary(FakeStats):
    """Resets its count, and mentions that only in the next summary."""

    restarts = 0

    def receive(self, now: float, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        if self.number is not None and number < self.number:
            self.restarts += 1
            self.total, self.first, self.number = 0, "", None
        yield from super().receive(now, data)

    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total}; {self.rate():.1f}; {self.first}; {self.last}; restarts {self.restarts}"


class GapCount(FakeStats):
    """Reports gaps only as a count in the summary."""

    gaps = 0

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
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
    """Reports the largest difference between two consecutive N, which is 1 if nothing is missing."""

    largest = 1

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        self.largest = max(self.largest, number - last)
        yield from ()

    def line(self) -> str:
        return f"n={self.total} hz={self.rate():.1f} largest step={self.largest} {self.first}..{self.last}"


class GapInWords(GapCount):
    """Has no gap count, but a different wording after a gap."""

    def line(self) -> str:
        word = "complete" if not self.missed else "some are missing"
        return f"{self.total} messages, {word}, {self.rate():.1f}/s, {self.first} - {self.last}"


class GapBeforeTheFirst(FakeStats):
    """Counts the messages before its first one as a gap."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if self.number is None:
            self.number = -1
        yield from super().receive(now, data)


class Noisy(FakeStats):
    """Logs each message, its size, and the count so far."""

    def log_received(self, data: str) -> Iterator[Log]:
        yield 20, f"I heard: {data}"
        yield 20, f"{len(data)} bytes, {self.total + 1} so far"


class OneLinePerValue(FakeStats):
    def summary(self) -> Iterator[Log]:
        yield 20, "=" * 30
        yield 20, "Statistik"
        yield 20, "-" * 30
        yield 20, f"Anzahl: {self.total}"
        yield 20, f"Rate: {self.rate():.1f} Nachrichten/s".replace(".", ",")
        yield 20, f"Erste: {self.first}"
        yield 20, f"Letzte: {self.last}"
        yield 20, "=" * 30


class MixedLevels(OneLinePerValue):
    def summary(self) -> Iterator[Log]:
        for level, (_, text) in zip((20, 30, 40, 20, 50, 20, 30, 40), super().summary(), strict=True):
            yield level, text


class NoisyAndLong(Noisy, OneLinePerValue):
    pass


class LastSecond(FakeStats):
    def rate(self) -> float:
        return len([at for at in self.times if at > self.times[-1] - 1.0])


class LastTwoSeconds(FakeStats):
    def rate(self) -> float:
        return len([at for at in self.times if at > self.times[-1] - 2.0]) / min(2.0, self.times[-1] - self.begin)


class LastTen(FakeStats):
    def rate(self) -> float:
        recent = self.times[-10:]
        return len(recent) / (recent[-1] - recent[0])


class LastInterval(FakeStats):
    def rate(self) -> float:
        return 1 / (self.times[-1] - self.times[-2])


class Intervals(FakeStats):
    def rate(self) -> float:
        return (self.total - 1) / (self.times[-1] - self.begin)


class Rounded(FakeStats):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total} ({round(self.rate())} Hz) {self.first} {self.last}"


class Scientific(FakeStats):
    def summary(self) -> Iterator[Log]:
        yield 20, f"n: {self.total:e}, hz: {self.rate():e}, {self.first!r}, {self.last!r}"


class WithClock(FakeStats):
    """Its summary also contains the time of day, the elapsed time and the period."""

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


class WithThousands(FakeStats):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total:,.1f} {self.rate() * 60:,.0f}/min {self.rate():,.3f}/s {self.first} {self.last}"


class OccasionalMessages(FakeStats):
    """Logs other messages now and then."""

    def log_received(self, data: str) -> Iterator[Log]:
        if self.total == 0:
            yield 20, f"first message: {data}"
        if self.total % 7 == 2:
            yield 20, f"still alive after {self.total + 1}"


class Delivered(FakeStats):
    """Reports the share of messages delivered instead of gaps."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        self.missed += max(0, number - last - 1)
        yield from ()

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} delivered={100 * self.total / (self.total + self.missed):.1f}%"


class CountOfExpected(Delivered):
    """Reports the number of messages received of those expected."""

    def summary(self) -> Iterator[Log]:
        for level, text in FakeStats.summary(self):
            yield level, f"{text} ({self.total} of {self.total + self.missed})"


class LostSoFar(Delivered):
    """Reports the number of lost messages with each message, and nowhere else."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        said = list(super().receive(now, data))
        yield 20, f"[{self.total}] {data}, lost so far: {self.missed}"
        yield from said

    def summary(self) -> Iterator[Log]:
        yield from FakeStats.summary(self)


class QuotesEveryMessage(FakeStats):
    """The summary quotes every message."""

    def __init__(self) -> None:
        super().__init__()
        self.all: list[str] = []

    def log_received(self, data: str) -> Iterator[Log]:
        self.all.append(data)
        yield from ()

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} all={self.all}"


class NumbersItsRuns(Restarting):
    """Its summary contains the number of the run; nothing else reveals a restart."""

    run: int = 1

    def receive(self, now: float, data: str) -> Iterator[Log]:
        self.run += self.number is not None and int(data.split(":")[1]) < self.number
        yield from (each for each in super().receive(now, data) if "restarted" not in each[1])

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"run {self.run}: {text}"


class SinceTheLastSummary(GapCount):
    """Reports the messages lost since the last summary."""

    def line(self) -> str:
        missed, self.missed = self.missed, 0
        return f"{self.total} at {self.rate():.1f}/s, {missed} lost: {self.first} to {self.last}"


class GapsSinceTheLastSummary(GapCount):
    def line(self) -> str:
        gaps, self.gaps = self.gaps, 0
        return f"{self.total} at {self.rate():.1f}/s, {gaps} new gaps: {self.first} to {self.last}"


class LatestStep(LargestStep):
    """Reports the size of the latest jump of N."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        self.largest = number - last
        yield from ()


class SinceTheLastGap(FakeStats):
    """Also reports the number of messages since the last gap, once there was one."""

    whole: int = -1

    def log_received(self, data: str) -> Iterator[Log]:
        self.whole += self.whole >= 0
        yield from ()

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        self.whole = 1
        yield from super().on_jump(last, number)

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} since the last gap: {self.whole}"


class QuotesBoth(FakeStats):
    """Its warning about a jump quotes the messages before and after it; a summary quotes two messages, too."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield 30, f"{number - last - 1} missing: Hello World: {last} -> Hello World: {number}"


class QuotesBothInThreeLines(FakeStats):
    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield 30, "GAP!"
        yield 30, f"before: Hello World: {last}"
        yield 30, f"after: Hello World: {number}"


class QuotesTheFirst(FakeStats):
    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield 20, f"since {self.first}: something is missing before Hello World: {number}"


class RestartsAndQuotesBoth(Restarting):
    def receive(self, now: float, data: str) -> Iterator[Log]:
        before = self.last
        for level, text in super().receive(now, data):
            yield level, f"{before} -> {data}: counting from zero" if "restarted" in text else text


class QuotesBothAndChangesWording(QuotesBoth, GapInWords):
    """After the jump, only their timing identifies the summaries."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from QuotesBoth.on_jump(self, last, number)
        yield from GapInWords.on_jump(self, last, number)


class MisleadingLabels(FakeStats):
    """The word "last" precedes the first message and "first" the last one, but neither is its label."""

    def summary(self) -> Iterator[Log]:
        rate = f"{self.rate():.2f}"
        yield 20, f"{self.total} at {rate}/s, the last 10 messages: {self.first} (first) to {self.last} (last)"


class CsvRow(GapCount):
    """A row of CSV."""

    def line(self) -> str:
        return f"{self.total},{self.rate():.2f},{self.missed},{self.first},{self.last}"


class LostSoFarWithEachMessage(GapCount):
    """Logs the count and the number of lost messages with each message."""

    start = 1

    def receive(self, now: float, data: str) -> Iterator[Log]:
        summary = list(super().receive(now, data))
        yield 20, f"[{self.total - 1 + self.start}] {data} (lost so far: {self.missed})"
        yield from summary


class LostSoFarCountedFromZero(LostSoFarWithEachMessage):
    start = 0


RIGHT = (
    MisleadingLabels, CsvRow, LostSoFarWithEachMessage, LostSoFarCountedFromZero,
    QuotesEveryMessage, Delivered, CountOfExpected, LostSoFar, NumbersItsRuns, FakeStats, Restarting,
    RestartsInTheSummary, GapCount, MissedCount, LossPercent, LossShare, LargestStep, GapInWords, GapBeforeTheFirst,
    Noisy, OneLinePerValue, MixedLevels, NoisyAndLong, LastSecond, LastTwoSeconds, LastTen, LastInterval,
    Intervals, Rounded, Scientific, WithClock,
    WithThousands, OccasionalMessages, QuotesBoth, QuotesBothInThreeLines, QuotesTheFirst, RestartsAndQuotesBoth,
    QuotesBothAndChangesWording, SinceTheLastSummary, GapsSinceTheLastSummary, LatestStep, SinceTheLastGap,
)  # fmt: skip


@pytest.mark.parametrize("node", RIGHT)
@pytest.mark.parametrize("late_s", [0.0005, 0.15, 0.3])
def test_correct_nodes_pass(node: type[FakeStats], late_s: float) -> None:
    assert_all_passed(judge_trials(node, late_s=late_s))


@pytest.mark.parametrize("node", RIGHT)
def test_correct_nodes_pass_whatever_numbers_are_chosen(node: type[FakeStats]) -> None:
    """Every number left out, each with one of the two ends of the first numbers; other nodes get the other end."""
    for missed in range(LEFT_OUT[0], LEFT_OUT[1] + 1):
        first = FIRST_NUMBERS[(RIGHT.index(node) + missed) % 2]
        steady_trial, jump_trial = steady(node()), jump(node(), missed, first=first)
        assert_passed(judge_slow_count(steady_trial, jump_trial))
        assert_passed(judge_slow_summary(steady_trial, jump_trial))
        assert_passed(judge_stated_rate(steady_trial, jump_trial))
        assert_passed(judge_rising(jump_trial, jump_twice(node(), missed, first=first), steady_trial))


@pytest.mark.parametrize("node", RIGHT)
@pytest.mark.parametrize("slow_s", [0.3, 0.9])
def test_summaries_from_a_slow_timer_pass(node: type[FakeStats], slow_s: float) -> None:
    assert_all_passed(judge_trials(node, slow_s=slow_s))


@pytest.mark.parametrize("between_s", [0.01, 0.04])
def test_a_summary_in_several_messages_may_be_spread_out(between_s: float) -> None:
    assert_all_passed(judge_trials(OneLinePerValue, between_s=between_s))


FORMATS = st.sampled_from([
    "{n} {r:.2f} {f} {l}", "{n} {r:.0f} {f} {l}", "{{'n': {n}, 'r': {r}, 'f': '{f}', 'l': '{l}'}}",
    "({n},{r:.2f},{f},{l})",
    "{f}|{l}|{n:05d}|{r:8.3f}", "n={n:.1f};r={r:.1f}/s;f={f};l={l}", "last: {l}\nfirst: {f}\nrate: {r}\ncount: {n}",
    "{n}件 毎秒{r:.1f}件 「{f}」「{l}」", "MessageStats(total_count={n}, first_message='{f}', last_message='{l}', "
    "start_time=1763726400.123, messages_per_second={r})", "#{n}: {r:g}Hz, «{f}» to «{l}»", "{n}/{r:.2f}/{f}/{l}",
    "{r:.2f} msgs/sec | {n} messages | {f} | {l}", "total {n} Hz: {r:.1f} ({f}, {l})", "{n} msg/s={r:.2f} {f} {l}",
    "ogółem {n}, {r:.2f} na sekundę, od {f} do {l}", "count............{n}\nrate.............{r:.2f}\n{f}\n{l}",
])  # fmt: skip


@settings(max_examples=50, deadline=None)
@given(
    written=FORMATS,
    hz=st.floats(4.9, 5.0),
    missed=st.integers(4, 8),
    seed=st.integers(0, 10_000),
    noisy=st.booleans(),
    late_s=st.floats(0.0005, 0.4),
    comma=st.booleans(),
)
def test_correct_nodes_pass_in_any_format(
    written: str, hz: float, missed: int, seed: int, noisy: bool, late_s: float, comma: bool
) -> None:
    jitter = random.Random(seed)

    class Formatted(Noisy if noisy else FakeStats):  # type: ignore[misc]
        def receive(self, now: float, data: str) -> Iterator[Log]:
            yield from super().receive(now + jitter.uniform(0, 0.01), data)

        def summary(self) -> Iterator[Log]:
            text = written.format(n=self.total, r=self.rate(), f="F", l="L")
            text = text.replace(".", ",") if comma and "," not in text and "1763726400" not in text else text
            yield 20, text.replace("F", self.first).replace("L", self.last)

    steady_trial, jump_trial = steady(Formatted(), hz, late_s=late_s), jump(Formatted(), missed, late_s=late_s)
    assert_passed(judge_slow_count(steady_trial, jump_trial))
    assert_passed(judge_stated_rate(steady_trial, jump_trial))
    assert_passed(judge_slow_summary(steady_trial, jump_trial))
    twice = jump_twice(Formatted(), missed, late_s=late_s)
    assert_passed(judge_rising(jump_trial, twice, steady_trial))
    assert_passed(judge_new_publisher(restart(Formatted(), late_s=late_s), steady_trial, jump_trial))


# Faulty nodes.


def stating(count: str = "{n}", rate: str = "{r:.2f}", first: str = "{f}", last: str = "{l}") -> type[FakeStats]:
    """A node whose summary has these values."""

    class Stating(FakeStats):
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


SWAPPED = [
    "{r:.2f} messages in total, {n:.2f} messages per second, {f}, {l}",
    "{r:.2f} msgs | {n} Hz | {f} | {l}",
    "{f}, {l}, total={r:.1f}, rate={n}/s",
]


@pytest.mark.parametrize("written", SWAPPED)
def test_a_count_in_place_of_the_rate_fails_both(written: str) -> None:
    class Swapped(FakeStats):
        def summary(self) -> Iterator[Log]:
            yield 20, written.format(n=self.total, r=self.rate(), f=self.first, l=self.last)

    verdicts = judge_trials(Swapped)
    failing = {name: verdict.cause.split(":")[0] for name, verdict in verdicts.items() if not verdict.passed}
    assert failing == {"count": "count and rate swapped", "rate": "count and rate swapped"}


STATES_WRONG = {
    "count: off by one": [stating(count="{more}"), stating(count="{less}")],
    "count: number taken for the count": [stating(count="{number}"), stating(count="{next}")],
    "count: missed messages counted": [stating(count="{received}")],
    "count: wrong count": [stating(count="1"), stating(count="{half}"), stating(count="10")],
    "rate: period instead of a rate": [stating(rate="{p:.3f}")],
    "rate: rate per minute": [stating(rate="{m:.1f}")],
    "rate: rate in another unit": [stating(rate="{kilo:.6f}")],
    "rate: counted from the node's start": [stating(rate="{since:.2f}")],
    "rate: wrong rate": [stating(rate=each) for each in ("{half}", "{off}", "{e:.2f}", "1.0", "5.0", "0", "-{r:.2f}")],
    "rate: seconds cut off": [stating(rate="{cut}")],
    "rate: no rate": [stating(rate="?")],
    "summary: first message missing": [stating(first="-")],
    "summary: last message missing": [stating(last="-")],
    "summary: first message overwritten": [stating(first="Hello World: 3")],
}  # fmt: skip


@pytest.mark.parametrize(
    ("breaks", "node"), [(breaks, node) for breaks, nodes in STATES_WRONG.items() for node in nodes]
)
def test_summaries_with_wrong_values_fail(breaks: str, node: type[FakeStats]) -> None:
    criterion, cause = breaks.split(": ", 1)
    assert_breaks(judge_trials(node), criterion, cause)


@pytest.mark.parametrize("wrong", [each for each in STATES_WRONG if each.startswith("rate: ")])
@pytest.mark.parametrize("late", [slice(0, 1), slice(1, 2)])
def test_a_wrong_rate_in_a_late_summary_is_diagnosed(wrong: str, late: slice) -> None:
    for node in STATES_WRONG[wrong]:
        steady_trial = steady(node())
        assert len(steady_trial.trace.logs) == 2
        logs = list(steady_trial.trace.logs)
        logs[late] = [replace(log, stamp=log.stamp + 0.25) for log in logs[late]]
        seen = replace(steady_trial, trace=replace(steady_trial.trace, logs=tuple(logs)))
        assert_failed(judge_stated_rate(seen, jump(node())), wrong.removeprefix("rate: "))


class HighestAsLast(FakeStats):
    """Reports the highest N as the last one, which is wrong after a restart."""

    highest: int = -1

    def log_received(self, data: str) -> Iterator[Log]:
        self.highest = max(self.highest, int(data.split(":")[1]))
        yield from ()

    def summary(self) -> Iterator[Log]:
        rate = self.rate()
        yield 20, f"{self.total} at {rate:.2f}, first={self.first} last=Hello World: {self.highest}"


class SummaryPerMessageAfterRestart(FakeStats):
    """Logs a summary for every message once N has fallen."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from super().on_jump(last, number)
        if number < last:
            self.every = 1


@dataclass
class StarvedAfterRestart(SummaryPerMessageAfterRestart):
    """A busy machine lets it run only at every third message of the new publisher: it receives three at once."""

    held: list[Log] = field(default_factory=list)

    def receive(self, now: float, data: str) -> Iterator[Log]:
        logs = list(super().receive(now, data))
        if self.every > 1:
            yield from logs
            return
        self.held.extend(logs)
        if self.total % 3 == 0:
            yield from self.held
            self.held.clear()


class SummaryBySlowTimer(FakeStats):
    """A timer logs the summary once there are ten more messages: the second one is late."""

    summed: int = 0

    def log_received(self, data: str) -> Iterator[Log]:
        if self.total // 10 > self.summed and (self.total > 23 or self.total < 20):
            self.summed = self.total // 10
            yield from super().summary()

    def summary(self) -> Iterator[Log]:
        yield from ()


def test_a_later_summary_may_wait_for_a_slow_timer() -> None:
    jump_trial = jump(SummaryBySlowTimer())
    assert [summary.messages for summary in find_summaries(jump_trial)] == [11, 25, 31]
    assert_passed(judge_slow_summary(steady(FakeStats()), jump_trial))
    assert_passed(judge_slow_count(steady(FakeStats()), jump_trial))


@pytest.mark.parametrize("between", [None, "3 lost in the last second"])
def test_a_summary_after_the_last_jump_is_no_reason_to_stop_listening(between: str | None) -> None:
    """A timer may still report the jump, as it has reported the first one."""
    trial = jump_twice(GapBlind())
    jumped_at = trial.sent[SECOND_JUMP_AFTER].at
    if between:
        at = trial.sent[JUMP_AFTER + 3].at
        trial = replace(
            trial, trace=replace(trial.trace, logs=(*trial.trace.logs, LogRecord(40, "node", between, at, at)))
        )
    assert find_summaries(trial)[-1].at > jumped_at
    assert not logs_something_new(jumped_at, trial)
    at = jumped_at + 0.9
    later = LogRecord(40, "node", "1 lost in the last second", at, at)
    assert logs_something_new(jumped_at, replace(trial, trace=replace(trial.trace, logs=(*trial.trace.logs, later))))


class PerMinuteLater(FakeStats):
    """From the second summary on, the rate is per minute."""

    def rate(self) -> float:
        return super().rate() * (60 if self.total > 10 else 1)


class CountsFromOne(FakeStats):
    def receive(self, now: float, data: str) -> Iterator[Log]:
        self.total = self.total or 1
        yield from super().receive(now, data)


class CountsOneTooFew(FakeStats):
    """Reports 10 at the eleventh message."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        self.total -= not self.first
        yield from super().receive(now, data)

    def summary(self) -> Iterator[Log]:
        yield from super().summary() if self.total else ()


class AlarmPerMessage(FakeStats):
    """Logs an alarm for every message."""

    def log_received(self, data: str) -> Iterator[Log]:
        missing = int(data.split(":")[1]) - (self.number if self.number is not None else -1) - 1
        yield 30, f"{missing} missing"

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from ()


class ListsFromThePrevious(AlarmPerMessage):
    """Lists the missing numbers from the last received one on, so that each message is a gap."""

    def log_received(self, data: str) -> Iterator[Log]:
        if self.number is not None:
            yield 30, f"missing: {list(range(self.number, int(data.split(':')[1])))}"


class ComparesTexts(FakeStats):
    """Compares the messages as texts, so that 10 is less than 9."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if data < self.last:
            yield 30, "out of sequence"
        yield from super().receive(now, data)

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        if number > last:
            yield 30, "out of sequence"


class GapBlind(FakeStats):
    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from ()


class GapBlindNoisy(GapBlind, NoisyAndLong):
    pass


class GapBlindOccasionalMessages(GapBlind, OccasionalMessages):
    pass


class GapBlindWithIds(GapBlind):
    def log_received(self, data: str) -> Iterator[Log]:
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


class LossKeepsRising(GapCount):
    """After a gap, the number of lost messages keeps rising: the expected number never catches up."""

    expected: int | None = None

    def log_received(self, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        if self.expected is not None and number > self.expected:
            self.missed += number - self.expected
        self.expected = number + 1 if self.expected is None else self.expected + 1
        yield from ()

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from ()

    def line(self) -> str:
        return f"{self.total} at {self.rate():.1f}/s, {self.missed} lost: {self.first} to {self.last}"


class GapsKeepRising(LossKeepsRising):
    """Counts every message after a gap as another gap."""

    def line(self) -> str:
        self.gaps = self.missed and self.gaps + min(10, self.total - JUMP_AFTER)
        return f"{self.total} at {self.rate():.1f}/s, {self.gaps} gaps: {self.first} to {self.last}"


class LossKeepsRisingInEachMessage(LossKeepsRising):
    """Reports this with each message, and not in the summary."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        yield from super().receive(now, data)
        yield 20, f"{data}, lost so far: {self.missed}"

    def line(self) -> str:
        return f"{self.total} at {self.rate():.1f}/s: {self.first} to {self.last}"


class OnlyDetectsLowerNumbers(FakeStats):
    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        if number < last:
            yield 30, "sequence went back"


class ToleratesOneMissing(FakeStats):
    """Ignores a gap of one message."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        return super().on_jump(last, number) if number > last + 2 else iter(())


class LosesOne(FakeStats):
    """Does not receive N = 100: the next message was in its queue of one before it was read."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        return super().receive(now, data) if data != "Hello World: 100" else iter(())


class SkipsTheFirstGap(FakeStats):
    """Ignores the first gap as a false alarm."""

    alarms = 0

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        self.alarms += number > last + 1
        if self.alarms > 1:
            yield from super().on_jump(last, number)


class OnlyTheFirstGap(FakeStats):
    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        return iter(()) if self.missed else super().on_jump(last, number)


class LargestGapOnly(FakeStats):
    """Reports a gap only if it is larger than all before."""

    largest = 1

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        if number > last + self.largest:
            self.largest = number - last
            yield 30, f"{number - last - 1} missing"


class GapCountResetTooFar(GapCount):
    """Resets its gap count too far to report another gap."""

    def line(self) -> str:
        gaps, self.gaps = self.gaps, -9
        return f"{self.total} at {self.rate():.1f}/s, {max(gaps, 0)} gaps: {self.first} to {self.last}"


class StopsAfterTwoSummaries(FakeStats):
    def summary(self) -> Iterator[Log]:
        if self.total <= 20:
            yield from super().summary()


class SilentReset(Restarting):
    def receive(self, now: float, data: str) -> Iterator[Log]:
        yield from (log for log in super().receive(now, data) if "restarted" not in log[1])


class DropsTheFirstAfterRestart(Restarting):
    """Resets its count and logs that, but does not count the message that revealed the restart."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        number = int(data.split(":")[1])
        fallen = self.number is not None and number < self.number
        yield from super().receive(now, data)
        if fallen:
            self.total, self.first = 0, ""


class SilentResetWithGapCount(SilentReset):
    """Its gap count stays the same and does not reveal a restart."""

    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text} gaps=0"


class DropsSeenTexts(FakeStats):
    """Drops messages that it takes for duplicates."""

    def __init__(self) -> None:
        super().__init__()
        self.seen: set[str] = set()

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if data not in self.seen:
            self.seen.add(data)
            yield from super().receive(now, data)


class WarnsForEverAfterAGap(FakeStats):
    """Updates the last number only if there was no gap: after a jump, every message is a gap."""

    level: int = 30

    def receive(self, now: float, data: str) -> Iterator[Log]:
        before = self.number
        yield from super().receive(now, data)
        if before is not None and self.number is not None and self.number > before + 1:
            self.number = before

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        for _, text in super().on_jump(last, number):
            yield self.level, text


class InformsForEverAfterAGap(WarnsForEverAfterAGap):
    level: int = 20


class ResetsAtAGap(FakeStats):
    """Resets its count at a jump, though a jump is not a restart."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from super().on_jump(last, number)
        if number > last:
            self.total = 1


class StopsSummariesAtAGap(FakeStats):
    """Reports a gap, and logs no more summaries."""

    stopped: bool = False

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from super().on_jump(last, number)
        self.stopped = number > last

    def summary(self) -> Iterator[Log]:
        if not self.stopped:
            yield from super().summary()


class EachSummaryTwice(FakeStats):
    """Logs each summary twice."""

    def summary(self) -> Iterator[Log]:
        yield from super().summary()
        yield from super().summary()


class PolledByTimer(FakeStats):
    """A timer logs a summary whenever the count is a multiple of ten: three times until the next message."""

    def summary(self) -> Iterator[Log]:
        for times in range(3):
            for level, text in super().summary():
                yield level, f"{text} after {1.84 + 0.05 * times:.2f} s"


class DropsLowerNumbers(FakeStats):
    """Drops messages that it takes for old."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if self.number is None or int(data.split(":")[1]) > self.number:
            yield from super().receive(now, data)


class NumberAsCountAfterRestart(FakeStats):
    """Uses N as the count after a restart."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        if number < last:
            self.total = 5
        yield from super().on_jump(last, number)


class OnlyTheFirstSummary(FakeStats):
    def summary(self) -> Iterator[Log]:
        if self.total == 10:
            yield from super().summary()


class EachSummaryTenLate(FakeStats):
    """Holds each summary back until the next one is due."""

    kept: tuple[Log, ...] = ()

    def summary(self) -> Iterator[Log]:
        yield from self.kept
        self.kept = tuple(super().summary())


class FirstOverwritten(FakeStats):
    def receive(self, now: float, data: str) -> Iterator[Log]:
        if self.total and self.total % 10 == 0:
            self.first = data
        yield from super().receive(now, data)


class Swapped(FakeStats):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total} at {self.rate():.2f}/s, first message: '{self.last}', last message: '{self.first}'"


class QuotesTheOneBeforeTheLast(FakeStats):
    """Quotes the message before the last one."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        before = self.last
        for level, text in super().receive(now, data):
            yield level, text.replace(f"last={data}", f"last={before}")


class NumberAsCount(FakeStats):
    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.number} at {self.rate():.2f}/s, {self.first} to {self.last}"


def test_a_wrong_count_already_fails_in_the_fast_stretch() -> None:
    for make, cause in ((CountsFromOne, "off by one"), (NumberAsCount, "number taken for the count")):
        early = judge_fast_count(fast(make()))
        assert early is not None
        assert_failed(early, cause)


def test_surplus_or_incomplete_summaries_already_fail_in_the_fast_stretch() -> None:
    cases: tuple[tuple[Callable[[], FakeStats], str], ...] = (
        (lambda: FakeStats(every=5), "too many summaries"),
        (FirstOverwritten, "first message overwritten"),
        (Swapped, "first and last swapped"),
    )
    for make, cause in cases:
        early = judge_fast_summary(fast(make()))
        assert early is not None
        assert_failed(early, cause)


class IrregularlyOften(FakeStats):
    """As if it summed up after every message, of which some come too fast to be told apart."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        self.every = 1 if (self.total + 1) % 7 in (0, 3) else 1000
        yield from super().receive(now, data)


def test_summaries_at_different_distances_are_left_to_the_slow_messages() -> None:
    assert judge_fast_summary(fast(IrregularlyOften())) is None
    assert_failed(judge_trials(IrregularlyOften)["summary"], "too many summaries")


class BoundedList(FakeStats):
    """Counts what is in a list of at most 20 messages, so that from the 20th on every message brings a summary."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        self.total = min(self.total, 19)
        yield from super().receive(now, data)


def test_summaries_that_come_too_often_later_on_fail_even_if_the_count_is_wrong() -> None:
    assert_failed(judge_slow_summary(steady(BoundedList()), jump(BoundedList())), "too many summaries")
    assert_failed(judge_trials(BoundedList)["count"], "wrong count")


@pytest.mark.parametrize("make", [FakeStats, CountsFromOne, FirstOverwritten])
def test_a_slow_or_partial_fast_stretch_gives_no_early_verdict(make: type[FakeStats]) -> None:
    slow = feed(make(), range(7, 7 + FAST_MESSAGES), FAST_HZ / 2)
    part = feed(make(), range(7, 7 + FAST_MESSAGES // 2), FAST_HZ)
    held_up = replace(fast(make()), cpu_wait_s=0.12)
    for seen in (slow, part, held_up):
        assert judge_fast_count(seen) is None
        assert judge_fast_summary(seen) is None


class RepeatsSummaryLater(FakeStats):
    """Logs another summary six messages after each."""

    def log_received(self, data: str) -> Iterator[Log]:
        if self.total % 10 == 6 and self.total > 10:
            yield from super().summary()


@pytest.mark.parametrize(
    ("node", "criterion", "cause"),
    [
        (CountsFromOne, "count", "off by one"),
        (HighestAsLast, "restart", "last message missing"),
        (SummaryPerMessageAfterRestart, "restart", "summary for every message"),
        (StarvedAfterRestart, "restart", "summary for every message"),
        (PerMinuteLater, "rate", "rate per minute"),
        (AlarmPerMessage, "gaps", "gap not noticed"),
        (ListsFromThePrevious, "gaps", "gap not noticed"),
        (ComparesTexts, "gaps", "false alarm"),
        *((node, "gaps", "gap not noticed") for node in (
            GapBlind, GapBlindNoisy, GapBlindOccasionalMessages, GapBlindWithIds, GapBlindRounded, GapBlindWithClock,
            GapCountStuck, GapCountRising, OnlyDetectsLowerNumbers, ToleratesOneMissing, OnlyTheFirstGap,
            SkipsTheFirstGap, LargestGapOnly, GapCountResetTooFar,
        )),
        (SilentReset, "restart", "starts over silently"),
        (SilentResetWithGapCount, "restart", "starts over silently"),
        (DropsSeenTexts, "restart", "stopped counting"),
        (DropsLowerNumbers, "restart", "stopped counting"),
        (WarnsForEverAfterAGap, "gaps", "false alarm"),
        (InformsForEverAfterAGap, "gaps", "false alarm"),
        (LossKeepsRising, "gaps", "false alarm"),
        (GapsKeepRising, "gaps", "false alarm"),
        (LossKeepsRisingInEachMessage, "gaps", "false alarm"),
        (ResetsAtAGap, "count", "wrong count"),
        (StopsSummariesAtAGap, "summary", "missing summary"),
        (EachSummaryTwice, "summary", "too many summaries"),
        (PolledByTimer, "summary", "too many summaries"),
        (NumberAsCountAfterRestart, "restart", "wrong count after a restart"),
        (OnlyTheFirstSummary, "summary", "missing summary"),
        (StopsAfterTwoSummaries, "summary", "missing summary"),
        (FirstOverwritten, "summary", "first message overwritten"),
        (QuotesTheOneBeforeTheLast, "summary", "last message missing"),
        (Swapped, "summary", "first and last swapped"),
        (RepeatsSummaryLater, "summary", "too many summaries"),
        (lambda: FakeStats(every=5), "summary", "too many summaries"),
        (lambda: FakeStats(every=3), "summary", "too many summaries"),
        (lambda: FakeStats(every=2), "summary", "too many summaries"),
        (lambda: FakeStats(every=1), "summary", "summary for every message"),
        (lambda: FakeStats(every=9), "summary", "missing summary"),
        (lambda: FakeStats(every=11), "summary", "missing summary"),
        (lambda: FakeStats(every=20), "summary", "missing summary"),
        (EachSummaryTenLate, "summary", "cannot keep up"),
    ],
)  # fmt: skip
def test_faulty_nodes_fail(node: Callable[[], FakeStats], criterion: str, cause: str) -> None:
    verdicts = judge_trials(node)
    if cause in ("missing summary", "cannot keep up"):  # summaries at other times may state anything
        verdicts = {name: v for name, v in verdicts.items() if name in ("summary", "gaps")}
    if cause == "summary for every message":  # no time has passed at the first message
        verdicts.pop("rate")
    assert_breaks(verdicts, criterion, cause)


def test_a_late_summary_with_a_wrong_count_is_not_a_missing_summary() -> None:
    steady_trial = steady(CountsFromOne())
    after_9, *others = steady_trial.trace.logs
    assert bisect_right([each.at for each in steady_trial.sent], after_9.stamp) == 9
    late = replace(after_9, stamp=steady_trial.sent[9].at + 0.01)
    seen = replace(steady_trial, trace=replace(steady_trial.trace, logs=(late, *others)))
    assert_failed(judge_slow_count(seen, jump(CountsFromOne())), "off by one")
    verdict = judge_slow_summary(seen, jump(CountsFromOne()))
    assert verdict.status is Status.SKIPPED, verdict


@pytest.mark.parametrize("late_s", [0.0005, 0.15, 0.24, 0.3])
def test_an_outdated_last_message_is_not_taken_for_a_wrong_count(late_s: float) -> None:
    assert_breaks(judge_trials(QuotesTheOneBeforeTheLast, late_s=late_s), "summary", "last message missing")


@pytest.mark.parametrize("late_s", [0.0005, 0.05, 0.1])
def test_a_node_that_drops_the_first_message_after_a_restart_counts_too_few(late_s: float) -> None:
    verdicts = judge_trials(DropsTheFirstAfterRestart, late_s=late_s)
    assert_breaks(verdicts, "restart", "wrong count after a restart")


@pytest.mark.parametrize("late_s", [0.0005, 0.15, 0.24, 0.3])
def test_a_late_summary_with_a_newer_last_message_counts_too_few(late_s: float) -> None:
    verdict = judge_slow_count(steady(CountsOneTooFew(), late_s=late_s), jump(CountsOneTooFew(), late_s=late_s))
    assert verdict.status is Status.FAILED, verdict


@pytest.mark.parametrize("missed", range(LEFT_OUT[0], LEFT_OUT[1] + 1))
@pytest.mark.parametrize(
    ("node", "late_s"),
    [*product([LossKeepsRising, GapsKeepRising], [0.0005, 0.3, 1.0]), (LossKeepsRisingInEachMessage, 0.0005)],
)
def test_a_loss_that_keeps_rising_is_recognised_whatever_number_is_chosen(
    node: type[FakeStats], late_s: float, missed: int
) -> None:
    trials = (jump(node(), missed, late_s=late_s), jump_twice(node(), missed, late_s=late_s))
    assert_failed(judge_rising(*trials, steady(node(), late_s=late_s)), "false alarm")


@dataclass
class RateOverTheLastSecond(FakeStats):
    """A node that counts the messages of each second, at 5 and then at 8 a second."""

    def summary(self) -> Iterator[Log]:
        hz = 5.0 if self.first.endswith(" 0") else {10: 5.0, 20: 7.0, 30: 8.0}[self.total]
        yield 20, f"count {self.total} hz {hz} first {self.first} last {self.last}"


def test_a_rate_that_rises_after_the_jump_is_no_loss() -> None:
    trials = (jump(RateOverTheLastSecond()), jump_twice(RateOverTheLastSecond()))
    assert_passed(judge_rising(*trials, steady(RateOverTheLastSecond())))


class KeepsTheRate(FakeStats):
    """Works the rate out for its first summary only."""

    kept: float = 0.0

    def rate(self) -> float:
        self.kept = self.kept or super().rate()
        return self.kept


class AlsoStatesTheFirstRate(KeepsTheRate):
    def summary(self) -> Iterator[Log]:
        for level, text in super().summary():
            yield level, f"{text}, now {FakeStats.rate(self):.2f}"


class KeepsWholeRate(KeepsTheRate):
    def summary(self) -> Iterator[Log]:
        yield 20, f"count={self.total} rate={self.rate():.0f} first={self.first} last={self.last}"


def test_a_rate_that_is_kept_when_it_changes_is_wrong() -> None:
    trials = steady(KeepsTheRate()), jump(KeepsTheRate())
    assert_passed(judge_stated_rate(*trials))
    assert_failed(judge_stated_rate(*trials, restart(KeepsTheRate())), "rate never updated", "still 8.89")


@pytest.mark.parametrize("node", [FakeStats, AlsoStatesTheFirstRate, KeepsWholeRate])
def test_another_rate_that_is_the_same_is_no_mistake(node: type[FakeStats]) -> None:
    assert_passed(judge_stated_rate(steady(FakeStats()), jump(FakeStats()), restart(node())))


class CutsTheContent(FakeStats):
    def summary(self) -> Iterator[Log]:
        yield 20, f"count={self.total} rate={self.rate():.2f} first={self.first[:12]} last={self.last[:12]}"


@pytest.mark.parametrize(
    ("code", "cause"), [("x = text[:12]", "content cut off"), ("x = text[-3:]", "first message missing")]
)
def test_a_slice_explains_a_content_without_its_number(code: str, cause: str) -> None:
    seen, jumped = steady(CutsTheContent()), jump(CutsTheContent())
    seen = replace(seen, trace=replace(seen.trace, sources={"message_stats.py": code}))
    assert_failed(judge_slow_summary(seen, jumped), cause)


def with_delays(trial: Trial, number: int, *, sent_late_s: float = 0.0, cpu_wait_s: float = 0.0) -> Trial:
    """The trial with this N sent late, and the node waiting for a CPU while it came."""
    after = number + 1
    sent = [
        replace(
            each,
            at=each.at + sent_late_s * (each.number == number),
            cpu_wait_s=each.cpu_wait_s + cpu_wait_s * (each.number >= after),
        )
        for each in trial.sent
    ]
    return replace(trial, sent=tuple(sent))


def test_a_loss_is_a_false_alarm_unless_the_machine_may_have_caused_it() -> None:
    jump_trial, steady_trial = jump(LosesOne()), steady(FakeStats())
    assert_failed(judge_jumps(jump_trial, steady_trial), "false alarm")
    assert_failed(judge_jumps(with_delays(jump_trial, 103, cpu_wait_s=0.1), steady_trial), "false alarm")
    for delays in ({"cpu_wait_s": 0.1}, {"sent_late_s": 0.1}, {"cpu_wait_s": 0.04, "sent_late_s": 0.04}):
        assert_undecided(judge_jumps(with_delays(jump_trial, 100, **delays), steady_trial))


class LosesOneEarly(FakeStats):
    """Does not receive N = 8, for the same reason."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if data != "Hello World: 8":
            yield from super().receive(now, data)


def test_a_message_that_a_node_may_have_lost_before_a_restart_is_undecided() -> None:
    restarted, others = restart(LosesOneEarly()), (steady(FakeStats()), jump(FakeStats()))
    assert_failed(judge_new_publisher(restarted, *others), "wrong count after a restart")
    hurried, starved = (with_delays(restarted, 8, cpu_wait_s=wait_s) for wait_s in (0.02, 0.1))
    assert_failed(judge_new_publisher(hurried, *others), "wrong count after a restart")
    assert_undecided(judge_new_publisher(starved, *others))


def test_a_count_of_one_fewer_is_undecided_where_the_node_may_have_lost_that_message() -> None:
    steady_trial, jump_trial = steady(FakeStats()), jump(LosesOne())
    assert_failed(judge_slow_count(steady_trial, jump_trial), "off by one")
    assert_failed(judge_slow_count(steady_trial, with_delays(jump_trial, 100, cpu_wait_s=0.02)), "off by one")
    starved = with_delays(jump_trial, 100, cpu_wait_s=0.1)
    assert_undecided(judge_slow_count(steady_trial, starved))
    always = [with_delays(run(CountsOneTooFew()), n, cpu_wait_s=0.1) for run, n in ((steady, 3), (jump, 100))]
    assert_failed(judge_slow_count(*always), "off by one")


@pytest.mark.parametrize("cpu_wait_s", [0.0, 0.02, 2.0])
def test_a_warning_about_one_gap_does_not_cover_the_other(cpu_wait_s: float) -> None:
    jump_trial = jump_twice(SkipsTheFirstGap(), cpu_wait_s=cpu_wait_s)
    assert_failed(judge_jumps(jump_trial, steady(SkipsTheFirstGap())), "gap not noticed")


@pytest.mark.parametrize(
    ("text", "passes"), [("2 gaps", True), (f"{LEFT_OUT[0] + 1} numbers are missing", True), ("a gap", False)]
)
def test_one_message_may_cover_both_gaps_if_the_node_was_starved(text: str, passes: bool) -> None:
    jump_trial, steady_trial = jump_twice(FakeStats()), steady(FakeStats())
    logs = [log for log in jump_trial.trace.logs if "missing" not in log.text]
    assert len(logs) == len(jump_trial.trace.logs) - 2
    at = jump_trial.sent[SECOND_JUMP_AFTER].at + 0.1
    both = replace(jump_trial, trace=replace(jump_trial.trace, logs=(*logs, LogRecord(30, "node", text, at, at))))
    assert_failed(judge_jumps(both, steady_trial), "gap not noticed")
    verdict = judge_jumps(replace(both, cpu_wait_s=0.5), steady_trial)
    assert verdict.passed == passes, verdict


@pytest.mark.parametrize("cpu_wait_s", [0.0, 2.0])
@pytest.mark.parametrize(("first", "late_s"), [(91, 0.0005), (92, 0.0005), (92, 0.124), (90, 0.0005)])
def test_an_alarm_next_to_a_summary_is_not_one_of_its_lines(first: int, late_s: float, cpu_wait_s: float) -> None:
    jump_trial, steady_trial = jump(ComparesTexts(), first=first), steady(ComparesTexts())
    alarm = next(log for log in jump_trial.trace.logs if log.text == "out of sequence")
    stamp = alarm.stamp + late_s
    logs = [replace(log, stamp=stamp, received_at=stamp) if log is alarm else log for log in jump_trial.trace.logs]
    jump_trial = replace(jump_trial, trace=replace(jump_trial.trace, logs=tuple(logs)), cpu_wait_s=cpu_wait_s)
    assert_passed(judge_slow_summary(steady_trial, jump_trial))
    assert_passed(judge_slow_count(steady_trial, jump_trial))
    assert_failed(judge_jumps(jump_trial, steady_trial), "false alarm")


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
    class Wrong(FakeStats):
        def summary(self) -> Iterator[Log]:
            yield 20, written.format(n=self.total + off, r=self.rate() * scale, f=self.first, l=self.last)

    off, scale = by, 1.0
    assert judge_slow_count(steady(Wrong(), hz), jump(Wrong())).status is Status.FAILED
    assert judge_stated_rate(steady(Wrong(), hz), jump(Wrong())).status is Status.PASSED
    off, scale = 0, factor
    assert judge_slow_count(steady(Wrong(), hz), jump(Wrong())).status is Status.PASSED
    assert judge_stated_rate(steady(Wrong(), hz), jump(Wrong())).status is Status.FAILED


def test_a_gap_that_is_only_printed_fails() -> None:
    jump_trial = jump(GapBlind())
    printed = replace(jump_trial.trace, output=trace(out="gap: 5 messages lost").output)
    printed = replace(printed, output=tuple(replace(line, at=jump_trial.sent[-1].at) for line in printed.output))
    assert_failed(
        judge_jumps(replace(jump_trial, trace=printed), steady(GapBlind())),
        "printed, not logged",
    )


# A node that is missing or exits.


class Waiting(FakeStats):
    """Logs all the time, whatever comes."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        yield 20, "waiting for the publisher"


def judge_silent(seen: Trace, **more: object) -> Verdict:
    steady_trial = replace(steady(FakeStats()), trace=seen, **more)  # type: ignore[arg-type]
    return judge_slow_summary(steady_trial, steady_trial)


def test_causes_of_no_summary() -> None:
    listening = trace(graph=LISTENING)
    assert_failed(judge_silent(listening), "no summary")
    assert_failed(judge_silent(listening, spins=False), "no spin")
    waits = trace(graph=LISTENING, logs=steady(Waiting()).trace.logs)
    file = f"{FOLDER}/stats.py"
    stuck_at = Frame(file, 12, "wait", "time.sleep(1)"), Frame(file, 20, "<module>", "main()")
    assert_failed(judge_silent(waits, spins=False, stuck=stuck_at), "no spin", "line 12")
    assert_failed(judge_silent(NO_NODE, sent=()), "no node")
    assert_failed(judge_silent(trace(), sent=()), "no subscription")
    assert_failed(
        judge_silent(trace(graph=LISTENING, out="10 from Hello World: 0 to Hello World: 9")), "printed, not logged"
    )
    assert_failed(judge_silent(trace(graph=LISTENING, err=CRASH, exit=exited(1))), "unhandled exception", "line 12")
    written = "[INFO] [17.1] [stats]: 10 from Hello World: 0 to Hello World: 9"
    assert_failed(judge_silent(trace(graph=LISTENING, err=written)), "not the node's logger")
    elsewhere = TopicEndpoint("/chatters", "std_msgs/msg/String", "/node")
    assert_failed(judge_silent(trace(graph=replace(NODE_UP, subscriptions=(elsewhere,))), sent=()), "wrong topic")


def test_without_a_summary_the_other_criteria_are_skipped() -> None:
    nothing = replace(steady(FakeStats()), trace=trace(graph=LISTENING))
    for verdict in (
        judge_slow_count(nothing, nothing),
        judge_stated_rate(nothing, nothing),
        judge_new_publisher(restart(FakeStats()), nothing, nothing),
        judge_rising(nothing, nothing, nothing),
    ):
        assert verdict.status is Status.SKIPPED


def test_a_node_that_exits_on_a_restart_or_a_jump_fails() -> None:
    steady_trial, jump_trial, restart_trial = steady(FakeStats()), jump(FakeStats()), restart(FakeStats())
    ended = replace(restart_trial, trace=replace(restart_trial.trace, exit=exited(0, after_s=4)))
    assert_failed(judge_new_publisher(ended, steady_trial, jump_trial), "exit at once")
    crashed = trace(graph=LISTENING, logs=jump_trial.trace.logs, err=CRASH, exit=exited(1))
    assert_failed(judge_jumps(replace(jump_trial, trace=crashed), steady_trial), "unhandled exception")
    twice = jump_twice(FakeStats())
    early = replace(twice, sent=twice.sent[:JUMP_AFTER], trace=replace(crashed, logs=twice.trace.logs[:1]))
    assert_failed(judge_rising(jump_trial, early, steady_trial), "unhandled exception")
    deaf = replace(restart_trial, sent=restart_trial.sent[:RESTART_AFTER], trace=trace(logs=restart_trial.trace.logs))
    assert_failed(judge_new_publisher(deaf, steady_trial, jump_trial), "no subscription")
    assert find_summaries(replace(deaf, trace=restart_trial.trace))[0].messages == 10


def test_shutdown() -> None:
    assert_passed(CHECKED["shutdown"](replace(fast(FakeStats()), ending=ending())))
    assert_failed(CHECKED["shutdown"](replace(fast(FakeStats()), ending=ending(still_running=True))), "does not end")


# Messages at a fast rate.


class SleepsBetweenMessages(FakeStats):
    """Receives at most ten messages a second, and loses the rest."""

    most_hz: float = 10.0

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if not self.times or now - self.times[-1] > 0.99 / self.most_hz:
            yield from super().receive(now, data)

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        yield from ()


class SleepsALittle(SleepsBetweenMessages):
    most_hz: float = 16.0


class DropsTwo(FakeStats):
    """Loses two messages, as with a queue of one and a short scheduling delay."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if data not in ("Hello World: 30", "Hello World: 31"):
            yield from super().receive(now, data)


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


def judge_fast(node: type[FakeStats], source: str = "", **more: object) -> Verdict:
    seen = fast(node(), **more)
    seen = replace(seen, trace=replace(seen.trace, sources={"node.py": source}))
    verdict: Verdict = CHECKED["count"](steady(node()), jump(node()), seen)
    return verdict


@pytest.mark.parametrize(
    ("source", "cause", "words"),
    [
        (NAPS, "nap between messages", "line 4"),
        (SLEEPS, "slow callback", "line 8"),
        (SLEEPS.replace("self.heard,", "lambda msg: self.heard(msg),"), "slow callback", "line 8"),
        (SHORT, "queue too short", "line 1"),
        ("", "cannot keep up", "there were 5"),
    ],
)
def test_causes_of_messages_lost_at_a_fast_rate(source: str, cause: str, words: str) -> None:
    for node in (SleepsBetweenMessages, SleepsALittle):
        assert_failed(judge_fast(node, source), cause, words)


@pytest.mark.parametrize("late_s", [0.0005, 0.1, 0.5, 1.0])
def test_a_node_that_loses_no_messages_may_be_late(late_s: float) -> None:
    for node in (FakeStats, OneLinePerValue, Noisy, QuotesEveryMessage, QuotesTheFirst, DropsTwo):
        assert_passed(judge_fast(node, NAPS, late_s=late_s))


class Throttled(FakeStats):
    """Logs at most one summary per `every_s`."""

    every_s: float = 1.0
    said_at: float = 0.0

    def receive(self, now: float, data: str) -> Iterator[Log]:
        logs = list(super().receive(now, data))
        if logs and now - self.said_at < self.every_s:
            return
        self.said_at = now if logs else self.said_at
        yield from logs


def test_a_summary_throttled_at_a_fast_rate_is_missing() -> None:
    source = "def heard(msg):\n    log.info('a',\n        throttle_duration_sec=1.0)\n"
    seen, steady_trial, jump_trial = fast(Throttled()), steady(Throttled()), jump(FakeStats())
    seen = replace(seen, trace=replace(seen.trace, sources={"node.py": source}))
    assert_passed(judge_slow_summary(steady_trial, jump_trial))
    assert_failed(judge_summary(steady_trial, jump_trial, seen), "log throttled", "line 2")
    plain = replace(seen, trace=replace(seen.trace, sources={}))
    assert_failed(judge_summary(steady_trial, jump_trial, plain), "missing summary", "tenth message")
    assert_undecided(judge_summary(steady_trial, jump_trial, replace(seen, cpu_wait_s=1.2)))


@pytest.mark.parametrize("late_s", [0.0005, 0.1, 0.5, 1.0])
def test_summaries_may_be_late_at_a_fast_rate(late_s: float) -> None:
    for node in (FakeStats, OneLinePerValue, Noisy, QuotesEveryMessage, QuotesTheFirst, DropsTwo):
        verdict = judge_summary(steady(node()), jump(node()), fast(node(), late_s=late_s))
        assert verdict.passed == judge_slow_summary(steady(node()), jump(node())).passed


def test_losses_that_a_busy_machine_may_explain_are_undecided() -> None:
    assert_undecided(judge_fast(SleepsALittle, cpu_wait_s=1.2))
    assert_failed(judge_fast(SleepsBetweenMessages, cpu_wait_s=0.2), "cannot keep up")
    assert_passed(judge_fast(FakeStats, cpu_wait_s=3.0))
    slowly = feed(FakeStats(), range(FAST_MESSAGES), 19.0)
    assert_undecided(judge_count(steady(FakeStats()), jump(FakeStats()), slowly))
    assert_failed(judge_count(steady(CountsFromOne()), jump(CountsFromOne()), slowly), "off by one")


# A single cause of several failures.

CHECKED = {criterion.id: criterion.judge for criterion in CHECK.criteria}
TWO_SUBSCRIPTIONS = """
self.one = self.create_subscription(String, 'chatter', self.heard, 10)

self.other = self.create_subscription(String, 'chatter', self.heard, 10)
"""


def judge_like_check(
    node: Callable[[], FakeStats], source: str = "", subscriptions: int = 1, *, late_s: float = 0.0005
) -> dict[str, Verdict]:
    """The verdicts that the check gives on a node with this source."""

    def with_source(seen: Trial) -> Trial:
        network = replace(LISTENING, subscriptions=subscriptions * LISTENING.subscriptions)
        return replace(seen, trace=replace(seen.trace, graph=network, sources={"node.py": source}))

    steady_trial, jump_trial = with_source(steady(node(), late_s=late_s)), with_source(jump(node(), late_s=late_s))
    restart_trial, fast_trial = with_source(restart(node(), late_s=late_s)), with_source(fast(node(), late_s=late_s))
    twice_trial = with_source(jump_twice(node(), late_s=late_s))
    zero_trial = with_source(jump_after_zero(node(), late_s=late_s))
    verdicts = {
        "count": CHECKED["count"](steady_trial, jump_trial, fast_trial),
        "rate": CHECKED["rate"](steady_trial, jump_trial, replace(restart_trial, sent=()), fast_trial),
        "summary": CHECKED["summary"](steady_trial, jump_trial, fast_trial),
        "restart": CHECKED["restart"](steady_trial, jump_trial, restart_trial, fast_trial),
        "gaps": CHECKED["gaps"](steady_trial, jump_trial, twice_trial, zero_trial, restart_trial, fast_trial),
    }
    return {name: explain(verdict) for name, verdict in verdicts.items()}


class MissesAfterZero(FakeStats):
    """Takes the last N for none where it is 0."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        if last:
            yield from super().on_jump(last, number)


class AnnouncesTheFirstLate(MissesAfterZero):
    """What it says about the first message comes with the second one."""

    def log_received(self, data: str) -> Iterator[Log]:
        if self.total == 1:
            yield 20, "receiving messages"


@pytest.mark.parametrize("node", [MissesAfterZero, AnnouncesTheFirstLate])
def test_a_jump_after_zero_must_be_reported(node: type[FakeStats]) -> None:
    assert_breaks(judge_trials(node), "gaps", "0 taken for no number")


def test_the_test_that_zero_does_not_pass_is_named() -> None:
    source = (
        "def heard(msg):\n    global last_number\n    n = int(msg.data.split(':')[1])\n"
        "    if last_number and n != last_number + 1:\n        node.get_logger().warning('gap')\n    last_number = n\n"
        "node.create_subscription(String, 'chatter', heard, 10)\n"
    )
    assert "line 4: last_number counts as false when it is 0" in judge_like_check(MissesAfterZero, source)["gaps"].cause


def saying_on_any_jump(text: str) -> type[FakeStats]:
    """A node that logs this text wherever N does not rise by one."""

    class SaysOnAnyJump(FakeStats):
        def on_jump(self, last: int, number: int) -> Iterator[Log]:
            missing, step = number - last - 1, number - last
            yield 30, text.format(missing=missing, step=step, last=last, number=number)

    return SaysOnAnyJump


class AddsUpEverything(FakeStats):
    """Its count of lost messages falls below 0 at a restart; no word says what it is."""

    def on_jump(self, last: int, number: int) -> Iterator[Log]:
        self.missed += number - last - 1
        yield from ()

    def summary(self) -> Iterator[Log]:
        yield 20, f"{self.total} {self.missed} {self.rate():.2f} {self.first} {self.last}"


@pytest.mark.parametrize(
    "text",
    [
        "missing {missing} messages",
        "Missed {step} message(s) between {last} and {number}",
        "{missing} messages missing between {last} and {number}",
        "Gap detected! Lost messages: {missing}",
        "gap from {last} to {number}: {missing} messages were lost",
        '{{"last": {last}, "n": {number}, "n_missed": {missing}}}',
        "LOST={missing}",
        "skipped {missing}",
        "{missing} Nachrichten fehlen",
        "Es wurden {missing} Nachrichten verloren",
        "Il manque {missing} messages",
        "{missing} 件のメッセージが欠落しました",
        "丢失 {missing} 条消息",
    ],
)
def test_a_negative_number_of_missing_messages_is_wrong(text: str) -> None:
    assert_breaks(judge_trials(saying_on_any_jump(text)), "gaps", "negative number of missing messages")


def test_a_count_of_lost_messages_below_zero_is_wrong_in_any_language() -> None:
    assert_breaks(judge_trials(AddsUpEverything), "gaps", "negative number of missing messages")


@pytest.mark.parametrize(
    "text",
    [
        "sequence went from {last} to {number} ({step})",
        "sequence went from {last} to {number} ({step:+d}), messages may be missing",
        "jump of {step}",
        "unexpected jump: {step}. Were messages lost?",
        "lost or restarted? N changed by {step}",
        "off by {missing}",
        "expected the next number, difference {missing}",
        "gap: {step}",
        "N: {last}->{number}, delta {step}, missing 0",
        "delta={step} lost=?",
        "step {step} without loss",
        "Fehler: {step}",
        "Sequenzsprung um {step}",
        "Lost the sequence: from {last} to {number} ({step})",
        "the sequence changed by {step}; a positive number means that messages are missing",
    ],
)
def test_a_negative_number_that_is_true_is_right(text: str) -> None:
    assert_all_passed(judge_trials(saying_on_any_jump(text)))


class RenewsItsSubscription(FakeStats):
    """Loses every seventh message, between two subscriptions."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        if int(data.split(":")[1]) % 7 != 5:
            yield from super().receive(now, data)


@pytest.mark.parametrize("node", [FakeStats, RenewsItsSubscription])
def test_a_node_that_renews_its_subscription_gets_the_same_verdicts_whatever_it_loses(node: type[FakeStats]) -> None:
    verdicts = judge_trials(node, new_subscriptions=17)
    assert_failed(verdicts.pop("count"), "a subscription for each message", "17 new subscriptions")
    del verdicts["rate"]  # judged without a fast stretch there
    assert {verdict.status for verdict in verdicts.values()} == {Status.SKIPPED}
    trials = [make(node(), new_subscriptions=17) for make in (steady, jump, restart, fast)]
    assert "see `count`" in judge_rate(*trials).cause


class SubscribedTwice(FakeStats):
    """Receives each message twice, through two subscriptions."""

    def receive(self, now: float, data: str) -> Iterator[Log]:
        yield from super().receive(now, data)
        yield from super().receive(now + 1e-4, data)


def test_two_subscriptions_are_the_cause_of_every_failure() -> None:
    failures = {
        n: v for n, v in judge_like_check(SubscribedTwice, TWO_SUBSCRIPTIONS, 2).items() if v.status is Status.FAILED
    }
    assert len(failures) >= 2
    for verdict in failures.values():
        assert_failed(verdict, "two subscriptions", "lines 2 and 4")


def test_two_subscriptions_are_blamed_only_if_they_exist_and_messages_count_twice() -> None:
    for verdict in (
        *judge_like_check(SubscribedTwice, TWO_SUBSCRIPTIONS, 1).values(),
        *judge_like_check(CountsFromOne, TWO_SUBSCRIPTIONS, 2).values(),
    ):
        assert "two subscriptions" not in verdict.cause


OWN_PUBLISHER = """\
class Stats(Node):
    def __init__(self):
        self.sub = self.create_subscription(String, 'chatter', self.heard, 10)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.log = self.create_publisher(String, 'log', 10)
    def heard(self, message):
        self.log.publish(message)
    def tick(self):
        self.pub.publish(String())
"""


@pytest.mark.parametrize(("topic", "blamed"), [("/chatter", True), ("/log", False)])
def test_a_node_that_publishes_on_the_topic_counts_its_own_messages(topic: str, blamed: bool) -> None:
    publisher = TopicEndpoint(topic, "std_msgs/msg/String", "/node")
    trials = [
        replace(each, trace=replace(each.trace, graph=network, sources={"node.py": OWN_PUBLISHER}))
        for each in (steady(CountsFromOne()), jump(CountsFromOne()), fast(CountsFromOne()))
        for network in (replace(LISTENING, publishers=(publisher,)),)
    ]
    verdict = explain(CHECKED["count"](*trials))
    assert verdict.status is Status.FAILED
    assert verdict.cause.startswith("own messages") == blamed


def test_a_sleep_in_the_callback_is_the_cause_of_every_failure() -> None:
    failures = {n: v for n, v in judge_like_check(FakeStats, SLEEPS, late_s=1.6).items() if v.status is Status.FAILED}
    assert len(failures) >= 1
    for verdict in failures.values():
        assert_failed(verdict, "slow callback", "line 8")


def test_a_sleep_in_a_wait_loop_is_not_blamed() -> None:
    waits = SLEEPS.replace("        time.sleep", "        while not self.total: time.sleep")
    assert not any(
        "slow callback" in verdict.cause for verdict in judge_like_check(FakeStats, waits, late_s=1.6).values()
    )


def test_a_sleep_is_not_blamed_if_the_node_keeps_up() -> None:
    for node in (CountsFromOne, FirstOverwritten, GapBlind, OneLinePerValue):
        assert not any("slow" in verdict.cause for verdict in judge_like_check(node, SLEEPS).values())


# A busy machine.


def test_a_first_message_delayed_by_the_machine_excuses_a_higher_rate() -> None:
    """The kernel reports a delay of half a second, so the node saw 10 messages in 1.3 s."""

    class FirstMessageLate(FakeStats):
        def rate(self) -> float:
            return self.total / (self.times[-1] - self.begin - 0.5)

    steady_trial = steady(FirstMessageLate())
    owed = [0.0, 0.25, *[0.5] * 18]
    excused = tuple(replace(each, cpu_wait_s=late) for each, late in zip(steady_trial.sent, owed, strict=True))
    assert_failed(judge_stated_rate(steady_trial, jump(FirstMessageLate())), "wrong rate")
    excused_trial = replace(steady_trial, sent=excused, cpu_wait_s=0.5)
    assert_passed(judge_stated_rate(excused_trial, jump(FirstMessageLate())))


def test_a_pace_at_which_truncated_seconds_look_right_is_undecided() -> None:
    cut = stating(rate="{cut}")
    assert_undecided(judge_stated_rate(steady(cut(), 4.4), jump(cut())))
    assert_passed(judge_stated_rate(steady(FakeStats(), 4.4), jump(FakeStats())))


class SinceItsStart(FakeStats):
    def rate(self) -> float:
        return self.total / (self.times[-1] - self.begin + 0.8)


class PerWholeSecondsOfLateMessages(FakeStats):
    def rate(self) -> float:
        return self.total / int(self.times[-1] - self.begin + 0.2)


@pytest.mark.parametrize(("node", "late_s"), [(SinceItsStart, 0.35), (PerWholeSecondsOfLateMessages, 0.2)])
def test_a_wrong_rate_of_a_summary_that_the_machine_delays_is_undecided(node: type[FakeStats], late_s: float) -> None:
    seen = steady(node(), late_s=late_s)
    assert_undecided(judge_stated_rate(replace(seen, cpu_wait_s=0.5), jump(node())))
    right = steady(FakeStats(), late_s=late_s)
    assert_passed(judge_stated_rate(replace(right, cpu_wait_s=0.5), jump(FakeStats())))


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
def test_possible_values_of_a_number(written: str, meant: float) -> None:
    assert meant in list(values(written))


def number_texts(text: str) -> tuple[str, ...]:
    return tuple(number.text for number in parse_log(LogRecord(20, "node", text, START, START), 1).numbers)


def test_which_parts_of_a_text_are_numbers() -> None:
    assert number_texts("10 of “Hello World: 12” at 15:04:05 on 2026-05-05") == ("10",)
    assert number_texts("\x1b[31m7\x1b[0m apples, -3 pears, 2-3 plums, \uff15") == ("7", "-3", "2", "3", "5")
    assert number_texts("合計10件") == ("10",)
    assert number_texts("no number at all") == ()
    assert number_texts("10'5 and 1_2") == ("10", "5", "1", "2")


def test_a_list_without_spaces_is_several_numbers() -> None:
    numbers = parse_log(LogRecord(20, "node", "20,4.95,5,Hello World: 0", START, START), 1).numbers
    assert [number.values for number in numbers] == [(20,), (4.95,), (5,)]
    numbers = parse_log(LogRecord(20, "node", "10,4,93,0", START, START), 1).numbers
    assert [number.value for number in numbers] == [10, 4, 93, 0]
    assert 4.93 in numbers[1].values
    assert number_texts("1,234.5 of 1.234,5") == ("1,234.5", "1.234,5")


@given(st.text(alphabet="0123456789.,'_-+eE \u2212\u2019\u202f\u00a0"))
def test_any_text_can_be_read(text: str) -> None:
    assert all(number.values for number in parse_log(LogRecord(20, "node", text, START, START), 1).numbers)


def test_messages_with_the_same_wording_are_of_the_same_kind() -> None:
    one, other = (
        parse_log(LogRecord(20, "node", text, START, START), 1)
        for text in ("got   Hello World: 9, 1 of 3 ###", "got Hello World: 10,  12.5 of -4 #####")
    )
    assert one.kind == other.kind
    assert (one.quoted, other.quoted) == ((9,), (10,))


def test_an_alarm_next_to_a_summary_is_not_part_of_the_next_one() -> None:
    class Beside(FakeStats):
        def log_received(self, data: str) -> Iterator[Log]:
            if self.total == 10:
                yield 30, "by the way: 3"

    assert [summary.messages for summary in find_summaries(steady(Beside()))] == [10, 20]
    assert [len(summary.lines) for summary in find_summaries(steady(Beside()))] == [1, 1]


def test_a_message_just_before_a_summary_is_due_is_not_part_of_it() -> None:
    jump_trial = jump(FakeStats())
    early = jump_trial.sent[29].at - 0.01
    logs = (*jump_trial.trace.logs, LogRecord(40, "node", "1 lost in the last second", early, early))
    jump_trial = replace(jump_trial, trace=replace(jump_trial.trace, logs=logs))
    assert [summary.messages for summary in find_summaries(jump_trial)] == [10, 20, 30]


def test_the_longest_delay_in_sending() -> None:
    steady_trial = steady(FakeStats())
    late = replace(
        steady_trial, sent=tuple(replace(each, at=each.at + 0.4 * (each.number > 12)) for each in steady_trial.sent)
    )
    assert steady_trial.max_delay_s == pytest.approx(0.0, abs=1e-6)
    assert late.max_delay_s == pytest.approx(0.4, abs=1e-3)
    assert restart(FakeStats()).max_delay_s == pytest.approx(0.0, abs=1e-6), "the absence of a publisher is not a delay"
    assert Trial(trace()).max_delay_s == 0.0


HEARD = """\
class Stats(Node):
    def __init__(self):
        self.count, self.last = 0, None
        self.create_subscription(String, 'chatter', self.heard, 10)
    def heard(self, message):
        number = {number}
{rest}
"""
COMPARED = "        if number != self.last + 1: self.alarm()\n"
READ = "int(message.data.split(':')[1])"


@pytest.mark.parametrize(
    ("node", "source", "cause"),
    [
        (GapBlind, HEARD.format(number="int(message.data[-1])", rest=""), "number misread"),
        (
            GapBlind,
            HEARD.format(
                number=READ, rest="        self.count += 1\n        if number != self.count: self.alarm()"
            ),
            "number compared with the count",
        ),
        (
            WarnsForEverAfterAGap,
            HEARD.format(number=READ, rest=COMPARED + "        else: self.last = number"),
            "last number out of date",
        ),
        (
            GapBlind,
            HEARD.format(number=READ, rest="        self.last = number\n        if number != self.last: self.alarm()"),
            "last number set too early",
        ),
        (
            OnlyDetectsLowerNumbers,
            HEARD.format(number=READ, rest="        if number < self.last: self.alarm()\n        self.last = number"),
            "only lower numbers",
        ),
        (
            GapBlind,
            HEARD.format(number=READ, rest=COMPARED + "        self.last = number"),
            "gap not noticed",
        ),
    ],
)  # fmt: skip
def test_the_source_shows_why_gaps_are_reported_wrongly(node: type[FakeStats], source: str, cause: str) -> None:
    assert_failed(judge_like_check(node, source)["gaps"], cause)


def test_a_comparison_of_texts_explains_a_silent_reset() -> None:
    rest = "        if message.data < self.last: self.count = 0\n        self.last = message.data"
    source = HEARD.format(number=READ, rest=rest)
    assert_failed(judge_like_check(SilentReset, source)["restart"], "texts compared", "line 7")


@pytest.mark.parametrize(
    ("totals", "words"), [(range(30, 31), "30"), (range(30, 32), "30 or 31"), (range(50, 60), "50 to 59")]
)
def test_possible_totals_in_words(totals: range, words: str) -> None:
    assert in_words(totals) == words
