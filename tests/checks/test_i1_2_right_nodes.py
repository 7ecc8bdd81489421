"""I1.2: nodes that are right pass, in whatever way people write them."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from checks.i1_2_message_statistics.feeding import logs_something_new
from checks.i1_2_message_statistics.logged_summaries import find_summaries
from checks.i1_2_message_statistics.plans import FIRST_NUMBERS, JUMP_AFTER, LEFT_OUT, SECOND_JUMP_AFTER
from tests.checks import statistics_nodes as nodes
from tests.checks.builders import assert_passed, ending
from tests.checks.statistics_nodes import (
    PLAIN,
    RIGHT,
    FakeStats,
    Make,
    node,
    restarting,
    saying_on_any_jump,
    silent_about_gaps,
)
from tests.checks.statistics_trials import (
    LATE_S,
    NOTHING,
    assert_all_passed,
    assert_failed,
    judge_trials,
    observe,
    restart,
    slowly,
    with_log,
)

QUOTES_BOTH = "{missing} missing: Hello World: {number} -> Hello World: {incoming}"
COMPLETE_OR_NOT = "{count} messages, complete, {rate:.1f}/s, {first} - {last}"
GAPS = "{count} at {rate:.1f}/s, {gaps} gaps: {first} to {last}"


def complete_or_not(node: FakeStats) -> str:
    return COMPLETE_OR_NOT.replace("complete", "some are missing") if node.missed else COMPLETE_OR_NOT


def in_last_seconds(node: FakeStats, seconds: float) -> int:
    return len([at for at in node.times if at > node.times[-1] - seconds])


RIGHT_NODES: dict[str, Make] = {
    "warns of a gap": RIGHT,
    "a gap before the first message": node(number=-1),
    "logs each message": nodes.NOISY,
    "a word now and then": node(heard=nodes.now_and_then),
    "quotes every message": nodes.QUOTES_ALL,
    # how gaps are told
    "a count of gaps": silent_about_gaps(GAPS),
    "a count of lost messages": silent_about_gaps("[{count}] [{rate:.1f}] [{missed}] [{first}] [{last}]"),
    "the loss in percent": silent_about_gaps(
        lambda node: f"{{count}} {{rate:.1f}} Hz {100 * node.missed / node.expected:.1f} % {{first}} {{last}}"),
    "the loss as a share": silent_about_gaps(
        lambda node: f"{{count}} {{rate:.1f}} Hz {node.missed / node.expected:.3f} {{first}} {{last}}"),
    "the share that was delivered": silent_about_gaps(
        lambda node: f"{PLAIN} delivered={100 * node.count / node.expected:.1f}%"),
    "how many came of how many": silent_about_gaps(PLAIN + " ({count} of {expected})"),
    "the loss with each message": silent_about_gaps(GAPS, counted="[{count}] {last} (lost so far: {missed})"),
    "the same, counted from 0": silent_about_gaps(
        GAPS, counted=lambda node: f"[{node.count - 1}] {{last}} (lost so far: {{missed}})"),
    "the loss with each message, nowhere else": silent_about_gaps(counted="[{count}] {last}, lost so far: {missed}"),
    "the loss since the last summary": silent_about_gaps(
        "{count} at {rate:.1f}/s, {missed} lost: {first} to {last}", at_summary={"missed": 0}),
    "the gaps since the last summary": silent_about_gaps(
        "{count} at {rate:.1f}/s, {gaps} new gaps: {first} to {last}", at_summary={"gaps": 0}),
    "how many since the last gap": node(summary=lambda node: (
        f"{PLAIN} since the last gap: {node.count - node.jumped_at + 1 if node.jumped_at else -1}")),
    "the largest step": silent_about_gaps("n={count} hz={rate:.1f} largest step={largest} {first}..{last}"),
    "the latest step": silent_about_gaps("n={count} hz={rate:.1f} largest step={step} {first}..{last}"),
    "in words that messages are missing": silent_about_gaps(complete_or_not),
    "quotes the messages around a jump": saying_on_any_jump(QUOTES_BOTH),
    "quotes them in three lines": saying_on_any_jump(
        ["GAP!", "before: Hello World: {number}", "after: Hello World: {incoming}"]),
    "quotes the first message at a jump": nodes.QUOTES_THE_FIRST,
    "other words from a jump on, so that only time tells summaries": saying_on_any_jump(
        QUOTES_BOTH, summary=complete_or_not),
    # how restarts are told
    "logs a restart": restarting(),
    "counts its restarts": restarting((), summary="{count}; {rate:.1f}; {first}; {last}; restarts {restarts}"),
    "numbers its runs": restarting((), summary=lambda node: f"run {node.restarts + 1}: {PLAIN}"),
    "quotes the messages around a restart": restarting("{last} -> {data}: counting from zero"),
    # how the rate is worked out
    "rate of the last second": node(rating=lambda node: in_last_seconds(node, 1)),
    "rate of the last two seconds": node(
        rating=lambda node: in_last_seconds(node, 2) / min(2, node.elapsed_s)),
    "rate of the last ten messages": node(rating=lambda node: 10 / (node.times[-1] - node.times[-10])),
    "rate by the last interval": node(rating=lambda node: 1 / (node.times[-1] - node.times[-2])),
    "rate by the intervals": node(rating=lambda node: (node.count - 1) / node.elapsed_s),
    # how a summary looks
    "one line per value": nodes.ONE_LINE_PER_VALUE,
    "many lines, and logs each message": node(heard=nodes.noisy, summary=nodes.one_line_per_value),
    "lines of several levels": node(summary=lambda node: (
        list(zip((20, 30, 40, 20, 50, 20, 30, 40), nodes.one_line_per_value(node), strict=True)))),
    "labels that mislead": node(
        summary="{count} at {rate:.2f}/s, the last 10 messages: {first} (first) to {last} (last)"),
    "a row of CSV": silent_about_gaps("{count},{rate:.2f},{missed},{first},{last}"),
    "a rounded rate": node(summary="{count} ({rate:.0f} Hz) {first} {last}"),
    "scientific notation": node(summary="n: {count:e}, hz: {rate:e}, {first!r}, {last!r}"),
    "a clock, in colour": node(summary=nodes.with_clock),
    "thousands": node(
        summary=lambda node: f"{{count:,.1f}} {node.rate * 60:,.0f}/min {{rate:,.3f}}/s {{first}} {{last}}"),
}  # fmt: skip
right_nodes = pytest.mark.parametrize("make", RIGHT_NODES.values(), ids=RIGHT_NODES)


@right_nodes
@pytest.mark.parametrize(
    "how", [{"late_s": LATE_S}, {"late_s": 0.15}, {"late_s": 0.3}, {"slow_s": 0.3}, {"slow_s": 0.9}]
)
def test_right_nodes_pass_however_late_they_or_their_summaries_are(make: Make, how: dict[str, Any]) -> None:
    assert_all_passed(judge_trials(make, **how))


@pytest.mark.parametrize("between_s", [0.01, 0.04])
def test_a_summary_in_several_messages_may_be_spread_out(between_s: float) -> None:
    assert_all_passed(judge_trials(nodes.ONE_LINE_PER_VALUE, between_s=between_s))


@right_nodes
def test_right_nodes_pass_whatever_numbers_are_chosen(make: Make) -> None:
    """Every number left out, each with one of the two ends of the first numbers; other nodes get the other end."""
    position = list(RIGHT_NODES.values()).index(make)
    for missed in range(LEFT_OUT[0], LEFT_OUT[1] + 1):
        trials = slowly(make, missed=missed, first=FIRST_NUMBERS[(position + missed) % 2])
        assert_all_passed({name: trials.judge(name) for name in ("count", "summary", "rate", "gaps")})


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
        def receive(self, now: float, data: str) -> Iterator[nodes.Log]:
            yield from super().receive(now + jitter.uniform(0, 0.01), data)

        def sum_up(self) -> Iterator[nodes.Log]:
            text = written.format(n=self.count, r=self.rate, f="F", l="L")
            text = text.replace(".", ",") if comma and "," not in text and "1763726400" not in text else text
            yield 20, text.replace("F", self.first).replace("L", self.last)

    make = node(Formatted, heard=nodes.noisy if chatty else ())
    trials = replace(slowly(make, hz=hz, missed=missed, late_s=late_s), restart=restart(make(), late_s=late_s))
    verdicts = {name: trials.judge(name) for name in ("count", "summary", "restart", "gaps")}
    assert_all_passed({**verdicts, "rate": replace(trials, restart=NOTHING).judge("rate")})


def test_a_later_summary_may_wait_for_a_slow_timer() -> None:
    slow = node(due=lambda node: False, heard=lambda node: PLAIN if node.count in (10, 24, 30) else ())
    trials = replace(slowly(RIGHT), jump=slowly(slow).jump)
    assert [summary.messages for summary in find_summaries(trials.jump)] == [11, 25, 31]
    assert_all_passed({name: trials.judge(name) for name in ("summary", "count")})


@pytest.mark.parametrize("between", [None, "3 lost in the last second"])
def test_a_summary_after_the_last_jump_is_no_reason_to_stop_listening(between: str | None) -> None:
    """A timer may still report the jump, as it has reported the first one."""
    trial = slowly(nodes.GAP_BLIND).jump_twice
    jumped_at = trial.sent[SECOND_JUMP_AFTER].at
    if between:
        trial = with_log(trial, between, trial.sent[JUMP_AFTER + 3].at, 40)
    assert find_summaries(trial)[-1].at > jumped_at
    assert not logs_something_new(jumped_at, trial)
    assert logs_something_new(jumped_at, with_log(trial, "1 lost in the last second", jumped_at + 0.9, 40))


def test_a_rate_that_rises_after_the_jump_is_no_loss() -> None:
    last_second = node(
        summary="count {count} hz {rate} first {first} last {last}",
        rating=lambda node: 5.0 if node.first.endswith(" 0") else {10: 5.0, 20: 7.0, 30: 8.0}[node.count],
    )
    assert_passed(slowly(last_second).judge("gaps"))


def rate_at_ten(node: FakeStats) -> float:
    """The rate that was worked out for the first summary."""
    return 10 / (node.times[9] - node.begin)


def test_a_rate_that_is_kept_when_it_changes_is_wrong() -> None:
    keeps = node(rating=rate_at_ten)
    assert_passed(slowly(keeps).judge("rate"))
    kept = replace(slowly(keeps), restart=restart(keeps())).judge("rate")
    assert_failed(kept, "rate never updated", "still 8.89")


@pytest.mark.parametrize(
    "make",
    [
        RIGHT,
        node(rating=rate_at_ten, summary=lambda node: f"{PLAIN}, now {nodes.true_rate(node):.2f}"),
        node(rating=rate_at_ten, summary="count={count} rate={rate:.0f} first={first} last={last}"),
    ],
    ids=["it is updated", "another is stated, too", "it is rounded"],
)
def test_another_rate_that_is_the_same_is_no_mistake(make: Make) -> None:
    assert_passed(replace(slowly(RIGHT), restart=restart(make())).judge("rate"))


def test_shutdown() -> None:
    trials = observe(RIGHT)
    ended, stays = (
        replace(trials, fast=replace(trials.fast, ending=ending(still_running=stays))) for stays in (False, True)
    )
    assert_passed(ended.judge("shutdown"))
    assert_failed(stays.judge("shutdown"), "does not end")
