"""I1.2: nodes that are right pass, in whatever way people write them."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from checks.i1_2_message_statistics.feeding import logs_something_new
from checks.i1_2_message_statistics.logged_summaries import find_summaries
from checks.i1_2_message_statistics.plans import FIRST_NUMBERS, JUMP_AFTER, LEFT_OUT, SECOND_JUMP_AFTER
from checks.i1_2_message_statistics.summary import judge_slow_summary
from tests.checks.builders import assert_passed, ending
from tests.checks.statistics_nodes import (
    GAP_BLIND,
    GAPS,
    LOST,
    NOISY,
    ONE_LINE_PER_VALUE,
    PLAIN,
    QUOTES_ALL,
    QUOTES_THE_FIRST,
    RIGHT,
    FakeStats,
    Log,
    Make,
    complete_or_not,
    node,
    noisy,
    now_and_then,
    one_line_per_value,
    restarting,
    saying_on_any_jump,
    silent_about_gaps,
    true_rate,
    with_clock,
)
from tests.checks.statistics_trials import (
    JUDGES,
    LATE_S,
    assert_all_passed,
    assert_failed,
    fast,
    judge_new_publisher,
    judge_rising,
    judge_slow_count,
    judge_stated_rate,
    judge_trials,
    jump,
    jump_twice,
    logged,
    restart,
    steady,
    with_trace,
)

QUOTES_BOTH = "{missing} missing: Hello World: {number} -> Hello World: {incoming}"
RIGHT_NODES: dict[str, Make] = {
    "warns of a gap": RIGHT,
    "labels that mislead": node(
        summary="{count} at {rate:.2f}/s, the last 10 messages: {first} (first) to {last} (last)"
    ),
    "a row of CSV": silent_about_gaps("{count},{rate:.2f},{missed},{first},{last}"),
    "the loss with each message": silent_about_gaps(GAPS, counted="[{count}] {last} (lost so far: {missed})"),
    "the same, counted from 0": silent_about_gaps(GAPS, counted="[{one_less}] {last} (lost so far: {missed})"),
    "the loss with each message, nowhere else": silent_about_gaps(counted="[{count}] {last}, lost so far: {missed}"),
    "quotes every message": QUOTES_ALL,
    "the share that was delivered": silent_about_gaps(
        lambda node: f"{PLAIN} delivered={100 * node.count / node.expected:.1f}%"
    ),
    "how many came of how many": silent_about_gaps(PLAIN + " ({count} of {expected})"),
    "logs a restart": restarting(),
    "counts its restarts": restarting((), summary="{count}; {rate:.1f}; {first}; {last}; restarts {restarts}"),
    "numbers its runs": restarting((), summary=lambda node: f"run {node.restarts + 1}: {PLAIN}"),
    "a count of gaps": silent_about_gaps(GAPS),
    "a count of lost messages": silent_about_gaps("[{count}] [{rate:.1f}] [{missed}] [{first}] [{last}]"),
    "the loss in percent": silent_about_gaps(
        lambda node: f"{{count}} {{rate:.1f}} Hz {100 * node.missed / node.expected:.1f} % {{first}} {{last}}"
    ),
    "the loss as a share": silent_about_gaps(
        lambda node: f"{{count}} {{rate:.1f}} Hz {node.missed / node.expected:.3f} {{first}} {{last}}"
    ),
    "the largest step": silent_about_gaps("n={count} hz={rate:.1f} largest step={largest} {first}..{last}"),
    "the latest step": silent_about_gaps("n={count} hz={rate:.1f} largest step={step} {first}..{last}"),
    "in words that messages are missing": silent_about_gaps(complete_or_not),
    "a gap before the first message": node(number=-1),
    "logs each message": NOISY,
    "one line per value": ONE_LINE_PER_VALUE,
    "lines of several levels": node(
        summary=lambda node: list(zip((20, 30, 40, 20, 50, 20, 30, 40), one_line_per_value(node), strict=True))
    ),
    "many lines, and logs each message": node(heard=noisy, summary=one_line_per_value),
    "a word now and then": node(heard=now_and_then),
    "rate of the last second": node(rating=lambda node: len([at for at in node.times if at > node.times[-1] - 1])),
    "rate of the last two seconds": node(
        rating=lambda node: (
            len([at for at in node.times if at > node.times[-1] - 2]) / min(2, node.times[-1] - node.begin)
        )
    ),
    "rate of the last ten messages": node(
        rating=lambda node: len(node.times[-10:]) / (node.times[-1] - node.times[-10:][0])
    ),
    "rate by the last interval": node(rating=lambda node: 1 / (node.times[-1] - node.times[-2])),
    "rate by the intervals": node(rating=lambda node: (node.count - 1) / (node.times[-1] - node.begin)),
    "a rounded rate": node(summary="{count} ({rate:.0f} Hz) {first} {last}"),
    "scientific notation": node(summary="n: {count:e}, hz: {rate:e}, {first!r}, {last!r}"),
    "a clock, in colour": node(summary=with_clock),
    "thousands": node(
        summary=lambda node: f"{{count:,.1f}} {node.rate * 60:,.0f}/min {{rate:,.3f}}/s {{first}} {{last}}"
    ),
    "quotes the messages around a jump": saying_on_any_jump(QUOTES_BOTH),
    "quotes them in three lines": saying_on_any_jump(
        ["GAP!", "before: Hello World: {number}", "after: Hello World: {incoming}"]
    ),
    "quotes the first message at a jump": QUOTES_THE_FIRST,
    "quotes the messages around a restart": restarting("{last} -> {data}: counting from zero"),
    "other words from a jump on, so that only time tells summaries": saying_on_any_jump(
        QUOTES_BOTH, summary=complete_or_not
    ),
    "the loss since the last summary": silent_about_gaps(LOST, at_summary={"missed": 0}),
    "the gaps since the last summary": silent_about_gaps(
        "{count} at {rate:.1f}/s, {gaps} new gaps: {first} to {last}", at_summary={"gaps": 0}
    ),
    "how many since the last gap": node(
        summary=lambda node: f"{PLAIN} since the last gap: {node.count - node.jumped_at + 1 if node.jumped_at else -1}"
    ),
}
right_nodes = pytest.mark.parametrize("make", RIGHT_NODES.values(), ids=RIGHT_NODES)


@right_nodes
@pytest.mark.parametrize("late_s", [LATE_S, 0.15, 0.3])
def test_right_nodes_pass(make: Make, late_s: float) -> None:
    assert_all_passed(judge_trials(make, late_s=late_s))


@right_nodes
@pytest.mark.parametrize("slow_s", [0.3, 0.9])
def test_summaries_from_a_slow_timer_pass(make: Make, slow_s: float) -> None:
    assert_all_passed(judge_trials(make, slow_s=slow_s))


@right_nodes
def test_right_nodes_pass_whatever_numbers_are_chosen(make: Make) -> None:
    """Every number left out, each with one of the two ends of the first numbers; other nodes get the other end."""
    position = list(RIGHT_NODES.values()).index(make)
    for missed in range(LEFT_OUT[0], LEFT_OUT[1] + 1):
        first = FIRST_NUMBERS[(position + missed) % 2]
        trials = steady(make()), jump(make(), missed, first=first)
        assert_passed(judge_slow_count(*trials))
        assert_passed(judge_slow_summary(*trials))
        assert_passed(judge_stated_rate(*trials))
        assert_passed(judge_rising(trials[1], jump_twice(make(), missed, first=first), trials[0]))


@pytest.mark.parametrize("between_s", [0.01, 0.04])
def test_a_summary_in_several_messages_may_be_spread_out(between_s: float) -> None:
    assert_all_passed(judge_trials(ONE_LINE_PER_VALUE, between_s=between_s))


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
    chatty=st.booleans(),
    late_s=st.floats(0.0005, 0.4),
    comma=st.booleans(),
)
def test_right_nodes_pass_in_any_format(
    written: str, hz: float, missed: int, seed: int, chatty: bool, late_s: float, comma: bool
) -> None:
    jitter = random.Random(seed)

    class Formatted(FakeStats):
        def receive(self, now: float, data: str) -> Iterator[Log]:
            yield from super().receive(now + jitter.uniform(0, 0.01), data)

        def sum_up(self) -> Iterator[Log]:
            text = written.format(n=self.count, r=self.rate, f="F", l="L")
            text = text.replace(".", ",") if comma and "," not in text and "1763726400" not in text else text
            yield 20, text.replace("F", self.first).replace("L", self.last)

    make = node(Formatted, heard=noisy if chatty else ())
    trials = steady(make(), hz, late_s=late_s), jump(make(), missed, late_s=late_s)
    assert_passed(judge_slow_count(*trials))
    assert_passed(judge_stated_rate(*trials))
    assert_passed(judge_slow_summary(*trials))
    assert_passed(judge_rising(trials[1], jump_twice(make(), missed, late_s=late_s), trials[0]))
    assert_passed(judge_new_publisher(restart(make(), late_s=late_s), *trials))


def test_a_later_summary_may_wait_for_a_slow_timer() -> None:
    slow = node(due=lambda node: False, heard=lambda node: PLAIN if node.count in (10, 24, 30) else ())
    jump_trial = jump(slow())
    assert [summary.messages for summary in find_summaries(jump_trial)] == [11, 25, 31]
    assert_passed(judge_slow_summary(steady(RIGHT()), jump_trial))
    assert_passed(judge_slow_count(steady(RIGHT()), jump_trial))


@pytest.mark.parametrize("between", [None, "3 lost in the last second"])
def test_a_summary_after_the_last_jump_is_no_reason_to_stop_listening(between: str | None) -> None:
    """A timer may still report the jump, as it has reported the first one."""
    trial = jump_twice(GAP_BLIND())
    jumped_at = trial.sent[SECOND_JUMP_AFTER].at
    if between:
        trial = with_trace(trial, logs=(*trial.trace.logs, logged(between, trial.sent[JUMP_AFTER + 3].at, 40)))
    assert find_summaries(trial)[-1].at > jumped_at
    assert not logs_something_new(jumped_at, trial)
    later = logged("1 lost in the last second", jumped_at + 0.9, 40)
    assert logs_something_new(jumped_at, with_trace(trial, logs=(*trial.trace.logs, later)))


def test_a_rate_that_rises_after_the_jump_is_no_loss() -> None:
    last_second = node(
        summary="count {count} hz {rate} first {first} last {last}",
        rating=lambda node: 5.0 if node.first.endswith(" 0") else {10: 5.0, 20: 7.0, 30: 8.0}[node.count],
    )
    assert_passed(judge_rising(jump(last_second()), jump_twice(last_second()), steady(last_second())))


def rate_at_ten(node: FakeStats) -> float:
    """The rate that was worked out for the first summary."""
    return 10 / (node.times[9] - node.begin)


def test_a_rate_that_is_kept_when_it_changes_is_wrong() -> None:
    keeps = node(rating=rate_at_ten)
    trials = steady(keeps()), jump(keeps())
    assert_passed(judge_stated_rate(*trials))
    assert_failed(judge_stated_rate(*trials, restart(keeps())), "rate never updated", "still 8.89")


@pytest.mark.parametrize(
    "make",
    [
        RIGHT,
        node(rating=rate_at_ten, summary=lambda node: f"{PLAIN}, now {true_rate(node):.2f}"),
        node(rating=rate_at_ten, summary="count={count} rate={rate:.0f} first={first} last={last}"),
    ],
    ids=["rate is updated", "first and last rate", "whole rate"],
)
def test_another_rate_that_is_the_same_is_no_mistake(make: Make) -> None:
    assert_passed(judge_stated_rate(steady(RIGHT()), jump(RIGHT()), restart(make())))


def test_shutdown() -> None:
    assert_passed(JUDGES["shutdown"](replace(fast(RIGHT()), ending=ending())))
    assert_failed(JUDGES["shutdown"](replace(fast(RIGHT()), ending=ending(still_running=True))), "does not end")
