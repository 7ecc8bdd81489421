"""I1.2: nodes that get one thing wrong fail by exactly that."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.checks import statistics_nodes as nodes
from tests.checks.builders import assert_skipped
from tests.checks.statistics_nodes import PLAIN, FakeStats, Log, Make, node, restarting, true_rate
from tests.checks.statistics_trials import LATE_S, assert_breaks, assert_failed, judge_trials, slowly, with_trace
from tutor.judge.verdict import Status


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


def stating(count: str = "{count}", rate: str = "{rate:.2f}", first: str = "{first}", last: str = "{last}") -> Make:
    """A node whose summary has these values."""
    return node(summary=" | ".join((count, rate, first, last)))


def stating_rate(rate: str, of: Callable[[FakeStats], float]) -> Make:
    """A node whose summary has this rate, worked out like this."""
    return node(summary=f"{{count}} | {rate} | {{first}} | {{last}}", rating=of)


WRONG_RATES: dict[str, list[Make]] = {
    "rate: period instead of a rate": [stating_rate("{rate:.3f}", lambda node: 1 / true_rate(node))],
    "rate: rate per minute": [stating_rate("{rate:.1f}", lambda node: 60 * true_rate(node))],
    "rate: rate in another unit": [stating_rate("{rate:.6f}", lambda node: true_rate(node) / 1000)],
    "rate: counted from the node's start": [
        stating_rate("{rate:.2f}", lambda node: node.count / (node.elapsed_s + 1.2)),
    ],
    "rate: seconds cut off": [stating_rate("{rate}", lambda node: node.count / max(1, int(node.elapsed_s)))],
    "rate: wrong rate": [
        stating_rate("{rate}", lambda node: true_rate(node) / 2),
        stating_rate("{rate}", lambda node: 1.45 * true_rate(node)),
        *(stating(rate=rate) for rate in ("{elapsed_s:.2f}", "1.0", "5.0", "0", "-{rate:.2f}")),
    ],
    "rate: no rate": [stating(rate="?")],
}
WRONG_VALUES: dict[str, list[Make]] = {
    "count: off by one": [stating(count="{one_more}"), node(summary=lambda node: (
        f"{node.count - 1} | {{rate:.2f}} | {{first}} | {{last}}"))],
    "count: number taken for the count": [stating(count="{number}"), node(summary=lambda node: (
        f"{node.incoming + 1} | {{rate:.2f}} | {{first}} | {{last}}"))],
    "count: missed messages counted": [stating(count="{expected}")],
    "count: wrong count": [stating(count="1"), stating(count="10"), node(summary=lambda node: (
        f"{node.rate / 2} | {{rate:.2f}} | {{first}} | {{last}}"))],
    "summary: first message missing": [stating(first="-")],
    "summary: last message missing": [stating(last="-")],
    "summary: first message overwritten": [stating(first="Hello World: 3")],
}  # fmt: skip


@pytest.mark.parametrize(
    ("breaks", "make"),
    [(breaks, make) for breaks, makes in {**WRONG_VALUES, **WRONG_RATES}.items() for make in makes],
)
def test_a_wrong_value_in_the_summaries_fails(breaks: str, make: Make) -> None:
    assert_breaks(judge_trials(make), breaks)


@pytest.mark.parametrize(
    ("breaks", "make"), [(breaks, make) for breaks, makes in WRONG_RATES.items() for make in makes]
)
@pytest.mark.parametrize("late", [0, 1])
def test_a_wrong_rate_in_a_late_summary_is_diagnosed(breaks: str, make: Make, late: int) -> None:
    trials = slowly(make)
    logs = list(trials.steady.trace.logs)
    assert len(logs) == 2
    logs[late] = replace(logs[late], stamp=logs[late].stamp + 0.25)
    trials = replace(trials, steady=with_trace(trials.steady, logs=tuple(logs)))
    assert_failed(trials.judge("rate"), breaks.removeprefix("rate: "))


@pytest.mark.parametrize(
    "summary",
    [
        "{rate:.2f} messages in total, {count:.2f} messages per second, {first}, {last}",
        "{rate:.2f} msgs | {count} Hz | {first} | {last}",
        "{first}, {last}, total={rate:.1f}, rate={count}/s",
    ],
)
def test_a_count_in_place_of_the_rate_fails_both(summary: str) -> None:
    verdicts = judge_trials(node(summary=summary))
    failing = {name: verdict.cause.split(":")[0] for name, verdict in verdicts.items() if not verdict.passed}
    assert failing == {"count": "count and rate swapped", "rate": "count and rate swapped"}


QUOTES_THE_ONE_BEFORE = node(
    summary=lambda node: f"count={{count}} rate={{rate:.2f}} first={{first}} last={node.messages[-2]}"
)
FAULTY_NODES: dict[str, dict[str, Make]] = {
    "count: off by one": {"counts from one": nodes.ONE_TOO_MANY},
    "count: wrong count": {"resets its count at a gap": node(at_gap={"count": 1})},
    "rate: rate per minute": {"except in the first summary": node(
        rating=lambda node: true_rate(node) * (60 if node.count > 10 else 1))},
    "restart: last message missing": {"the highest N as the last one": node(summary=lambda node: (
        f"{{count}} at {{rate:.2f}}, first={{first}} last=Hello World: {max(node.numbers)}"))},
    "restart: summary for every message": {
        "once N has fallen": node(at_fall={"every": 1}),
        "once N has fallen, on a busy machine": node(StarvedAfterRestart, at_fall={"every": 1}),
    },
    "restart: starts over silently": {
        "resets its count": restarting(()),
        "a gap count that reveals no restart": restarting((), summary=PLAIN + " gaps=0"),
    },
    "restart: stopped counting": {
        "drops texts that it has seen": node(takes=lambda node: node.data not in node.messages),
        "drops lower numbers": node(takes=lambda node: node.number is None or node.incoming > node.number),
    },
    "restart: wrong count after a restart": {"N as the count": node(at_fall={"count": 5})},
    "summary: missing summary": {
        "none after a gap": node(at_gap={"every": 1000}, at_fall={"every": 10}),
        "only the first": node(due=lambda node: node.count == 10),
        "only the first two": node(due=lambda node: node.count in (10, 20)),
        **{f"every {every}": node(every=every) for every in (9, 11, 20)},
    },
    "summary: too many summaries": {
        "each twice": node(summary=[PLAIN, PLAIN]),
        "by a timer, three times until the next message": node(
            summary=[f"{PLAIN} after {1.84 + 0.05 * times:.2f} s" for times in range(3)]),
        "once more six messages later": node(
            heard=lambda node: PLAIN if node.count % 10 == 6 and node.count > 10 else ()),
        **{f"every {every}": node(every=every) for every in (2, 3, 5)},
    },
    "summary: summary for every message": {"every message": node(every=1)},
    "summary: first message overwritten": {"by the eleventh": nodes.FIRST_OVERWRITTEN},
    "summary: last message missing": {"the one before the last": QUOTES_THE_ONE_BEFORE},
    "summary: first and last swapped": {"swapped": node(summary=nodes.SWAPPED)},
    "summary: cannot keep up": {"each ten messages late": node(EachSummaryTenLate)},
}  # fmt: skip


@pytest.mark.parametrize(
    ("breaks", "make"),
    [
        pytest.param(breaks, make, id=f"{breaks}, {what}")
        for breaks in FAULTY_NODES
        for what, make in FAULTY_NODES[breaks].items()
    ],
)
def test_faulty_nodes_fail(breaks: str, make: Make) -> None:
    verdicts = judge_trials(make)
    if breaks in ("summary: missing summary", "summary: cannot keep up"):  # one at another time may state anything
        verdicts = {name: verdicts[name] for name in ("summary", "gaps")}
    if breaks.endswith("summary for every message"):  # no time has passed at the first message
        verdicts.pop("rate")
    assert_breaks(verdicts, breaks)


@pytest.mark.parametrize("late_s", [LATE_S, 0.15, 0.24, 0.3])
def test_an_outdated_last_message_is_not_taken_for_a_wrong_count(late_s: float) -> None:
    assert_breaks(judge_trials(QUOTES_THE_ONE_BEFORE, late_s=late_s), "summary: last message missing")


@pytest.mark.parametrize("late_s", [LATE_S, 0.05, 0.1])
def test_a_node_that_drops_the_first_message_after_a_restart_counts_too_few(late_s: float) -> None:
    verdicts = judge_trials(restarting(of=DropsTheFirstAfterRestart), late_s=late_s)
    assert_breaks(verdicts, "restart: wrong count after a restart")


@pytest.mark.parametrize("late_s", [LATE_S, 0.15, 0.24, 0.3])
def test_a_late_summary_with_a_newer_last_message_counts_too_few(late_s: float) -> None:
    assert slowly(nodes.ONE_TOO_FEW, late_s=late_s).judge("count").status is Status.FAILED


def test_summaries_that_come_too_often_later_on_fail_even_if_the_count_is_wrong() -> None:
    assert_failed(slowly(node(BoundedList)).judge("summary"), "too many summaries")
    assert_failed(judge_trials(node(BoundedList))["count"], "wrong count")


def test_a_late_summary_with_a_wrong_count_is_not_a_missing_summary() -> None:
    trials = slowly(nodes.ONE_TOO_MANY)
    sent, (after_9, *others) = trials.steady.sent, trials.steady.trace.logs
    assert bisect_right([message.at for message in sent], after_9.stamp) == 9
    late = replace(after_9, stamp=sent[9].at + 0.01)
    trials = replace(trials, steady=with_trace(trials.steady, logs=(late, *others)))
    assert_failed(trials.judge("count"), "off by one")
    assert_skipped(trials.judge("summary"), "")


@settings(max_examples=50, deadline=None)
@given(
    written=st.sampled_from(["{n} {r:.2f} {f} {l}", "({n},{r:.1f},{f},{l})", "{f} {l}\n{r} Hz\n{n} messages"]),
    by=st.sampled_from([-3, -2, -1, 1, 2, 3]),
    factor=st.one_of(st.floats(0.1, 0.7), st.floats(1.4, 9.0)),
    hz=st.floats(4.9, 5.0),
)
def test_a_wrong_number_is_found_in_any_format(written: str, by: int, factor: float, hz: float) -> None:
    for off, scale, failing in ((by, 1.0, "count"), (0, factor, "rate")):
        make = node(
            summary=lambda node, off=off, scale=scale: written.format(
                n=node.count + off, r=node.rate * scale, f=node.first, l=node.last
            )
        )
        for criterion in ("count", "rate"):
            status = Status.FAILED if criterion == failing else Status.PASSED
            assert slowly(make, hz=hz).judge(criterion).status is status
