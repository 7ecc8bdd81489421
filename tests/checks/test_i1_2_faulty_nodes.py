"""I1.2: nodes that get one thing wrong fail by exactly that."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from checks.i1_2_message_statistics.summary import judge_slow_summary
from tests.checks.builders import assert_skipped
from tests.checks.statistics_nodes import (
    FIRST_OVERWRITTEN,
    ONE_TOO_FEW,
    ONE_TOO_MANY,
    PLAIN,
    BoundedList,
    DropsTheFirstAfterRestart,
    EachSummaryTenLate,
    Make,
    StarvedAfterRestart,
    Wording,
    node,
    receiving,
    restarting,
    true_rate,
)
from tests.checks.statistics_trials import (
    LATE_S,
    assert_breaks,
    assert_failed,
    judge_slow_count,
    judge_stated_rate,
    judge_trials,
    jump,
    steady,
    with_trace,
)
from tutor.judge.verdict import Status


def stating(
    count: Wording = "{count}", rate: Wording = "{rate:.2f}", first: str = "{first}", last: str = "{last}"
) -> Make:
    """A node whose summary has these values."""
    return node(
        summary=lambda node: " | ".join(
            str(part(node)) if callable(part) else str(part) for part in (count, rate, first, last)
        )
    )


WRONG_VALUES: dict[str, list[Make]] = {
    "count: off by one": [stating(count="{one_more}"), stating(count="{one_less}")],
    "count: number taken for the count": [
        stating(count="{number}"),
        stating(count=lambda node: str((node.number or 0) + 1)),
    ],
    "count: missed messages counted": [stating(count="{expected}")],
    "count: wrong count": [stating(count="1"), stating(count="10"), stating(count=lambda node: str(node.rate / 2))],
    "rate: period instead of a rate": [stating(rate=lambda node: f"{1 / node.rate:.3f}")],
    "rate: rate per minute": [stating(rate=lambda node: f"{60 * node.rate:.1f}")],
    "rate: rate in another unit": [stating(rate=lambda node: f"{node.rate / 1000:.6f}")],
    "rate: counted from the node's start": [
        stating(rate=lambda node: f"{node.count / (node.times[-1] - node.begin + 1.2):.2f}")
    ],
    "rate: wrong rate": [
        stating(rate=lambda node: str(node.rate / 2)),
        stating(rate=lambda node: str(1.45 * node.rate)),
        stating(rate=lambda node: f"{node.times[-1] - node.begin:.2f}"),
        *map(lambda rate: stating(rate=rate), ("1.0", "5.0", "0", "-{rate:.2f}")),
    ],
    "rate: seconds cut off": [stating(rate=lambda node: str(node.count / max(1, int(node.times[-1] - node.begin))))],
    "rate: no rate": [stating(rate="?")],
    "summary: first message missing": [stating(first="-")],
    "summary: last message missing": [stating(last="-")],
    "summary: first message overwritten": [stating(first="Hello World: 3")],
}
WRONG_RATES = [
    (make, wrong.removeprefix("rate: "))
    for wrong, makes in WRONG_VALUES.items()
    if wrong.startswith("rate: ")
    for make in makes
]


@pytest.mark.parametrize(
    ("breaks", "make"), [(breaks, make) for breaks, makes in WRONG_VALUES.items() for make in makes]
)
def test_a_wrong_value_in_the_summaries_fails(breaks: str, make: Make) -> None:
    assert_breaks(judge_trials(make), *breaks.split(": ", 1))


@pytest.mark.parametrize(("make", "cause"), WRONG_RATES)
@pytest.mark.parametrize("late", [0, 1])
def test_a_wrong_rate_in_a_late_summary_is_diagnosed(make: Make, cause: str, late: int) -> None:
    steady_trial = steady(make())
    logs = list(steady_trial.trace.logs)
    assert len(logs) == 2
    logs[late] = replace(logs[late], stamp=logs[late].stamp + 0.25)
    assert_failed(judge_stated_rate(with_trace(steady_trial, logs=tuple(logs)), jump(make())), cause)


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
LAST_OF_ALL = node(
    summary=lambda node: f"{{count}} at {{rate:.2f}}, first={{first}} last=Hello World: {max(node.numbers)}"
)

FAULTY_NODES: dict[str, list[tuple[str, Make]]] = {
    "count: off by one": [("counts from one", ONE_TOO_MANY)],
    "count: wrong count": [("resets its count at a gap", node(at_gap={"count": 1}))],
    "rate: rate per minute": [
        ("per minute, but not in the first summary", node(
            rating=lambda node: true_rate(node) * (60 if node.count > 10 else 1)
        )),
    ],
    "restart: last message missing": [("the highest N as the last one", LAST_OF_ALL)],
    "restart: summary for every message": [
        ("once N has fallen", node(at_fall={"every": 1})),
        ("once N has fallen, on a busy machine", node(StarvedAfterRestart, at_fall={"every": 1})),
    ],
    "restart: starts over silently": [
        ("resets its count", restarting(())),
        ("a gap count that reveals no restart", restarting((), summary=PLAIN + " gaps=0")),
    ],
    "restart: stopped counting": [
        ("drops texts that it has seen", receiving(lambda node: node.data not in node.messages)),
        ("drops lower numbers", receiving(lambda node: node.number is None or node.incoming > node.number)),
    ],
    "restart: wrong count after a restart": [("uses N as the count", node(at_fall={"count": 5}))],
    "summary: missing summary": [
        ("stops at a gap", node(at_gap={"every": 1000}, at_fall={"every": 10})),
        ("only the first", node(due=lambda node: node.count == 10)),
        ("only the first two", node(due=lambda node: node.count in (10, 20))),
        *((f"every {every}", node(every=every)) for every in (9, 11, 20)),
    ],
    "summary: too many summaries": [
        ("each twice", node(summary=[PLAIN, PLAIN])),
        ("by a timer, three times until the next message", node(
            summary=[f"{PLAIN} after {1.84 + 0.05 * times:.2f} s" for times in range(3)]
        )),
        ("once more six messages later", node(
            heard=lambda node: PLAIN if node.count % 10 == 6 and node.count > 10 else ()
        )),
        *((f"every {every}", node(every=every)) for every in (2, 3, 5)),
    ],
    "summary: summary for every message": [("every message", node(every=1))],
    "summary: first message overwritten": [("by the eleventh", FIRST_OVERWRITTEN)],
    "summary: last message missing": [("quotes the one before", QUOTES_THE_ONE_BEFORE)],
    "summary: first and last swapped": [
        ("swapped", node(summary="{count} at {rate:.2f}/s, first message: '{last}', last message: '{first}'")),
    ],
    "summary: cannot keep up": [("each ten messages late", node(EachSummaryTenLate))],
}  # fmt: skip


@pytest.mark.parametrize(
    ("breaks", "make"),
    [
        pytest.param(breaks, make, id=f"{breaks}, {what}")
        for breaks, makes in FAULTY_NODES.items()
        for what, make in makes
    ],
)
def test_faulty_nodes_fail(breaks: str, make: Make) -> None:
    criterion, cause = breaks.split(": ", 1)
    verdicts = judge_trials(make)
    if cause in ("missing summary", "cannot keep up"):  # summaries at other times may state anything
        verdicts = {name: verdicts[name] for name in ("summary", "gaps")}
    if cause == "summary for every message":  # no time has passed at the first message
        verdicts.pop("rate")
    assert_breaks(verdicts, criterion, cause)


@pytest.mark.parametrize(
    ("make", "breaks", "late_s"),
    [
        *((QUOTES_THE_ONE_BEFORE, "summary: last message missing", late_s) for late_s in (LATE_S, 0.15, 0.24, 0.3)),
        *(
            (restarting(of=DropsTheFirstAfterRestart), "restart: wrong count after a restart", late_s)
            for late_s in (LATE_S, 0.05, 0.1)
        ),
    ],
)
def test_faulty_nodes_fail_however_late_they_are(make: Make, breaks: str, late_s: float) -> None:
    assert_breaks(judge_trials(make, late_s=late_s), *breaks.split(": ", 1))


@pytest.mark.parametrize("late_s", [LATE_S, 0.15, 0.24, 0.3])
def test_a_late_summary_with_a_newer_last_message_counts_too_few(late_s: float) -> None:
    verdict = judge_slow_count(steady(ONE_TOO_FEW(), late_s=late_s), jump(ONE_TOO_FEW(), late_s=late_s))
    assert verdict.status is Status.FAILED, verdict


def test_summaries_that_come_too_often_later_on_fail_even_if_the_count_is_wrong() -> None:
    make = node(BoundedList)
    assert_failed(judge_slow_summary(steady(make()), jump(make())), "too many summaries")
    assert_failed(judge_trials(make)["count"], "wrong count")


def test_a_late_summary_with_a_wrong_count_is_not_a_missing_summary() -> None:
    steady_trial = steady(ONE_TOO_MANY())
    after_9, *others = steady_trial.trace.logs
    assert bisect_right([message.at for message in steady_trial.sent], after_9.stamp) == 9
    late = replace(after_9, stamp=steady_trial.sent[9].at + 0.01)
    trials = with_trace(steady_trial, logs=(late, *others)), jump(ONE_TOO_MANY())
    assert_failed(judge_slow_count(*trials), "off by one")
    assert_skipped(judge_slow_summary(*trials), "")


@settings(max_examples=50, deadline=None)
@given(
    written=st.sampled_from(["{n} {r:.2f} {f} {l}", "({n},{r:.1f},{f},{l})", "{f} {l}\n{r} Hz\n{n} messages"]),
    by=st.sampled_from([-3, -2, -1, 1, 2, 3]),
    factor=st.one_of(st.floats(0.1, 0.7), st.floats(1.4, 9.0)),
    hz=st.floats(4.9, 5.0),
)
def test_a_wrong_number_is_found_in_any_format(written: str, by: int, factor: float, hz: float) -> None:
    def verdicts(off: int, scale: float) -> list[Status]:
        make = node(
            summary=lambda node: written.format(n=node.count + off, r=node.rate * scale, f=node.first, l=node.last)
        )
        trials = steady(make(), hz), jump(make())
        return [judge(*trials).status for judge in (judge_slow_count, judge_stated_rate)]

    assert verdicts(by, 1.0) == [Status.FAILED, Status.PASSED]
    assert verdicts(0, factor) == [Status.PASSED, Status.FAILED]
