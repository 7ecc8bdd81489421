"""I1.2: messages at a rate that is common on robots: who loses some, and what can be told early."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from checks.i1_2_message_statistics.count import judge_fast_count
from checks.i1_2_message_statistics.plans import FAST_HZ, FAST_MESSAGES
from checks.i1_2_message_statistics.summary import judge_fast_summary, judge_slow_summary
from tests.checks.builders import assert_passed, assert_skipped, assert_undecided
from tests.checks.statistics_nodes import (
    FIRST_OVERWRITTEN,
    GAP_BLIND,
    LOSES_TWO,
    NOISY,
    ONE_LINE_PER_VALUE,
    ONE_TOO_MANY,
    QUOTES_ALL,
    QUOTES_THE_FIRST,
    RIGHT,
    Make,
    Throttled,
    node,
    receiving,
)
from tests.checks.statistics_trials import (
    JUDGES,
    LATE_S,
    assert_failed,
    fast,
    feed,
    judge_trials,
    jump,
    restart,
    steady,
    with_trace,
)
from tutor.judge.verdict import Status, Verdict


def at_most(hz: float) -> Make:
    """A node that receives at most so many messages a second, and loses the rest."""
    return receiving(lambda node: not node.times or node.now - node.times[-1] > 0.99 / hz, gap=())


SLOW, A_LITTLE_SLOW = at_most(10.0), at_most(16.0)
LOSE_NONE = (RIGHT, ONE_LINE_PER_VALUE, NOISY, QUOTES_ALL, QUOTES_THE_FIRST, LOSES_TWO)
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
IRREGULAR = node(due=lambda node: node.count % 7 in (0, 3))
"""As if it summed up after every message, of which some come too fast to be told apart."""


def judge_fast(make: Make, source: str = "", **how: Any) -> Verdict:
    verdict: Verdict = JUDGES["count"](
        steady(make()), jump(make()), with_trace(fast(make(), **how), sources={"node.py": source})
    )
    return verdict


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
    assert_failed(judge_fast(make, source), cause, words)


@pytest.mark.parametrize("make", LOSE_NONE)
@pytest.mark.parametrize("late_s", [LATE_S, 0.1, 0.5, 1.0])
def test_a_node_that_loses_no_messages_may_be_late(late_s: float, make: Make) -> None:
    assert_passed(judge_fast(make, NAPS, late_s=late_s))
    slowly = steady(make()), jump(make())
    assert JUDGES["summary"](*slowly, fast(make(), late_s=late_s)).passed == judge_slow_summary(*slowly).passed


def test_losses_that_a_busy_machine_may_explain_are_undecided() -> None:
    assert_undecided(judge_fast(A_LITTLE_SLOW, cpu_wait_s=1.2))
    assert_failed(judge_fast(SLOW, cpu_wait_s=0.2), "cannot keep up")
    assert_passed(judge_fast(RIGHT, cpu_wait_s=3.0))
    slowly = feed(RIGHT(), range(FAST_MESSAGES), 19.0)
    assert_undecided(JUDGES["count"](steady(RIGHT()), jump(RIGHT()), slowly))
    assert_failed(JUDGES["count"](steady(ONE_TOO_MANY()), jump(ONE_TOO_MANY()), slowly), "off by one")


def test_a_summary_throttled_at_a_fast_rate_is_missing() -> None:
    source = "def heard(msg):\n    log.info('a',\n        throttle_duration_sec=1.0)\n"
    seen, slowly = fast(node(Throttled)()), (steady(node(Throttled)()), jump(RIGHT()))
    throttled = with_trace(seen, sources={"node.py": source})
    assert_passed(judge_slow_summary(*slowly))
    assert_failed(JUDGES["summary"](*slowly, throttled), "log throttled", "line 2")
    assert_failed(JUDGES["summary"](*slowly, seen), "missing summary", "tenth message")
    assert_undecided(JUDGES["summary"](*slowly, replace(throttled, cpu_wait_s=1.2)))


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        (ONE_TOO_MANY, "off by one"),
        (node(summary="{number} at {rate:.2f}/s, {first} to {last}"), "number taken for the count"),
    ],
)
def test_a_wrong_count_already_fails_in_the_fast_stretch(make: Make, cause: str) -> None:
    assert_failed(judge_fast_count(fast(make())), cause)


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        (node(every=5), "too many summaries"),
        (FIRST_OVERWRITTEN, "first message overwritten"),
        (
            node(summary="{count} at {rate:.2f}/s, first message: '{last}', last message: '{first}'"),
            "first and last swapped",
        ),
    ],
)
def test_surplus_or_incomplete_summaries_already_fail_in_the_fast_stretch(make: Make, cause: str) -> None:
    assert_failed(judge_fast_summary(fast(make())), cause)


def test_summaries_at_different_distances_are_left_to_the_slow_messages() -> None:
    assert judge_fast_summary(fast(IRREGULAR())) is None
    assert_failed(judge_trials(IRREGULAR)["summary"], "too many summaries")


@pytest.mark.parametrize("make", [RIGHT, ONE_TOO_MANY, FIRST_OVERWRITTEN])
def test_a_slow_or_partial_fast_stretch_gives_no_early_verdict(make: Make) -> None:
    slow = feed(make(), range(7, 7 + FAST_MESSAGES), FAST_HZ / 2)
    part = feed(make(), range(7, 7 + FAST_MESSAGES // 2), FAST_HZ)
    held_up = replace(fast(make()), cpu_wait_s=0.12)
    for seen in (slow, part, held_up):
        assert judge_fast_count(seen) is None
        assert judge_fast_summary(seen) is None


@pytest.mark.parametrize("make", [RIGHT, receiving(lambda node: node.incoming % 7 != 5)], ids=["all", "loses some"])
def test_a_node_that_renews_its_subscription_gets_the_same_verdicts_whatever_it_loses(make: Make) -> None:
    verdicts = judge_trials(make, new_subscriptions=17)
    assert_failed(verdicts.pop("count"), "a subscription for each message", "17 new subscriptions")
    verdicts["rate"] = JUDGES["rate"](*(trial(make(), new_subscriptions=17) for trial in (steady, jump, restart, fast)))
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


@pytest.mark.parametrize("make", [ONE_TOO_MANY, FIRST_OVERWRITTEN, GAP_BLIND, ONE_LINE_PER_VALUE])
def test_a_sleep_is_not_blamed_if_the_node_keeps_up(make: Make) -> None:
    assert not any("slow" in verdict.cause for verdict in judge_trials(make, SLEEPS).values())
