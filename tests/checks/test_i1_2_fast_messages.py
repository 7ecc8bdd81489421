"""I1.2: messages at a rate that is common on robots: who loses some, and what can be told early."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from checks.i1_2_message_statistics.count import judge_fast_count
from checks.i1_2_message_statistics.plans import FAST_HZ, FAST_MESSAGES
from checks.i1_2_message_statistics.summary import judge_fast_summary
from tests.checks import statistics_nodes as nodes
from tests.checks.builders import assert_passed, assert_skipped, assert_undecided
from tests.checks.statistics_nodes import FIRST_OVERWRITTEN, ONE_TOO_MANY, RIGHT, FakeStats, Log, Make, node
from tests.checks.statistics_trials import (
    LATE_S,
    Trials,
    assert_failed,
    fast,
    judge_trials,
    observe,
    slowly,
    with_trace,
)
from tutor.judge.verdict import Status


def at_most(hz: float) -> Make:
    """A node that receives at most so many messages a second, and loses the rest."""
    return nodes.silent_about_gaps(takes=lambda node: not node.times or node.now - node.times[-1] > 0.99 / hz)


SLOW, A_LITTLE_SLOW = at_most(10.0), at_most(16.0)
LOSES_TWO = node(takes=lambda node: node.incoming not in (30, 31))
"""As with a queue of one and a short scheduling delay."""

IRREGULAR = node(due=lambda node: node.count % 7 in (0, 3))
"""As if it summed up after every message, of which some come too fast to be told apart."""

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
SHORT_QUEUE = "node.create_subscription(String, 'chatter', heard, 1)"
THROTTLES = "def heard(msg):\n    log.info('a',\n        throttle_duration_sec=1.0)\n"


class Throttled(FakeStats):
    """Logs at most once a second."""

    said_at: float = 0.0

    def receive(self, now: float, data: str) -> Iterator[Log]:
        logs = list(super().receive(now, data))
        if not logs or now - self.said_at >= 1.0:
            self.said_at = now if logs else self.said_at
            yield from logs


def fed_fast(make: Make, source: str = "", **how: Any) -> Trials:
    """What is observed of a node with this source if the messages also come fast, like this."""
    return replace(slowly(make), fast=with_trace(fast(make(), **how), sources={"node.py": source}))


@pytest.mark.parametrize("make", [SLOW, A_LITTLE_SLOW], ids=["10 Hz", "16 Hz"])
@pytest.mark.parametrize(
    ("source", "cause", "words"),
    [
        (NAPS, "nap between messages", "line 4"),
        (SLEEPS, "slow callback", "line 8"),
        (SLEEPS.replace("self.heard,", "lambda msg: self.heard(msg),"), "slow callback", "line 8"),
        (SHORT_QUEUE, "queue too short", "line 1"),
        ("", "cannot keep up", "there were 5"),
    ],
)
def test_causes_of_messages_lost_at_a_fast_rate(source: str, cause: str, words: str, make: Make) -> None:
    assert_failed(fed_fast(make, source).judge("count"), cause, words)


@pytest.mark.parametrize(
    "make",
    [RIGHT, nodes.ONE_LINE_PER_VALUE, nodes.NOISY, nodes.QUOTES_ALL, nodes.QUOTES_THE_FIRST, LOSES_TWO],
    ids=["right", "one line per value", "noisy", "quotes all", "quotes the first", "loses two"],
)
@pytest.mark.parametrize("late_s", [LATE_S, 0.1, 0.5, 1.0])
def test_a_node_that_loses_no_messages_may_be_late(late_s: float, make: Make) -> None:
    trials = fed_fast(make, NAPS, late_s=late_s)
    assert_passed(trials.judge("count"))
    assert trials.judge("summary").passed == slowly(make).judge("summary").passed


def test_losses_that_a_busy_machine_may_explain_are_undecided() -> None:
    assert_undecided(fed_fast(A_LITTLE_SLOW, cpu_wait_s=1.2).judge("count"))
    assert_failed(fed_fast(SLOW, cpu_wait_s=0.2).judge("count"), "cannot keep up")
    assert_passed(fed_fast(RIGHT, cpu_wait_s=3.0).judge("count"))
    too_slowly = fast(RIGHT(), first=0, hz=19.0)
    assert_undecided(replace(slowly(RIGHT), fast=too_slowly).judge("count"))
    assert_failed(replace(slowly(ONE_TOO_MANY), fast=too_slowly).judge("count"), "off by one")


def test_a_summary_throttled_at_a_fast_rate_is_missing() -> None:
    throttled, plain = fast(node(Throttled)()), replace(slowly(RIGHT), steady=slowly(node(Throttled)).steady)
    seen = with_trace(throttled, sources={"node.py": THROTTLES})
    assert_passed(plain.judge("summary"))
    assert_failed(replace(plain, fast=seen).judge("summary"), "log throttled", "line 2")
    assert_failed(replace(plain, fast=throttled).judge("summary"), "missing summary", "tenth message")
    assert_undecided(replace(plain, fast=replace(seen, cpu_wait_s=1.2)).judge("summary"))


@pytest.mark.parametrize(
    ("make", "cause"), [(ONE_TOO_MANY, "off by one"), (nodes.N_AS_COUNT, "number taken for the count")]
)
def test_a_wrong_count_already_fails_in_the_fast_stretch(make: Make, cause: str) -> None:
    assert_failed(judge_fast_count(fast(make())), cause)


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        (node(every=5), "too many summaries"),
        (FIRST_OVERWRITTEN, "first message overwritten"),
        (node(summary=nodes.SWAPPED), "first and last swapped"),
    ],
)
def test_surplus_or_incomplete_summaries_already_fail_in_the_fast_stretch(make: Make, cause: str) -> None:
    assert_failed(judge_fast_summary(fast(make())), cause)


def test_summaries_at_different_distances_are_left_to_the_slow_messages() -> None:
    assert judge_fast_summary(fast(IRREGULAR())) is None
    assert_failed(judge_trials(IRREGULAR)["summary"], "too many summaries")


@pytest.mark.parametrize("make", [RIGHT, ONE_TOO_MANY, FIRST_OVERWRITTEN])
@pytest.mark.parametrize("how", [{"hz": FAST_HZ / 2}, {"messages": FAST_MESSAGES // 2}, {"cpu_wait_s": 0.12}])
def test_a_slow_or_partial_fast_stretch_gives_no_early_verdict(make: Make, how: dict[str, Any]) -> None:
    seen = fast(make(), **how)
    assert judge_fast_count(seen) is None
    assert judge_fast_summary(seen) is None


@pytest.mark.parametrize("make", [RIGHT, node(takes=lambda node: node.incoming % 7 != 5)], ids=["all", "loses some"])
def test_a_node_that_renews_its_subscription_gets_the_same_verdicts_whatever_it_loses(make: Make) -> None:
    verdicts = judge_trials(make, new_subscriptions=17)
    assert_failed(verdicts.pop("count"), "a subscription for each message", "17 new subscriptions")
    verdicts["rate"] = observe(make, new_subscriptions=17).judge("rate")
    for verdict in verdicts.values():
        assert_skipped(verdict, "see `count`")


def test_a_sleep_in_the_callback_is_the_cause_of_every_failure() -> None:
    failures = [v for v in judge_trials(RIGHT, SLEEPS, late_s=1.6).values() if v.status is Status.FAILED]
    assert failures
    for verdict in failures:
        assert_failed(verdict, "slow callback", "line 8")


def test_a_sleep_in_a_wait_loop_is_not_blamed() -> None:
    waits = SLEEPS.replace("        time.sleep", "        while not self.total: time.sleep")
    assert not any("slow callback" in verdict.cause for verdict in judge_trials(RIGHT, waits, late_s=1.6).values())


@pytest.mark.parametrize("make", [ONE_TOO_MANY, FIRST_OVERWRITTEN, nodes.GAP_BLIND, nodes.ONE_LINE_PER_VALUE])
def test_a_sleep_is_not_blamed_if_the_node_keeps_up(make: Make) -> None:
    assert not any("slow" in verdict.cause for verdict in judge_trials(make, SLEEPS).values())
