"""I1.2: what a busy machine may explain is not held against a node, and everything else is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from checks.i1_2_message_statistics.gaps import judge_jumps
from checks.i1_2_message_statistics.plans import LEFT_OUT, SECOND_JUMP_AFTER
from checks.i1_2_message_statistics.summary import judge_slow_summary
from checks.i1_2_message_statistics.trial import Trial
from tests.checks.builders import assert_passed, assert_undecided, trace
from tests.checks.statistics_nodes import MISSING, ONE_TOO_FEW, RIGHT, FakeStats, node, receiving
from tests.checks.statistics_trials import (
    LATE_S,
    assert_failed,
    judge_new_publisher,
    judge_slow_count,
    judge_stated_rate,
    jump,
    jump_twice,
    logged,
    restart,
    steady,
    with_delays,
    with_trace,
)

LOSES_100 = receiving(lambda node: node.incoming != 100)
"""Does not receive N = 100: the next message was in its queue of one before it was read."""

LOSES_8 = receiving(lambda node: node.incoming != 8)

Delays = dict[str, float]


@pytest.mark.parametrize(
    ("number", "delays", "excused"),
    [
        (100, {}, False),
        (103, {"cpu_wait_s": 0.1}, False),
        (100, {"cpu_wait_s": 0.1}, True),
        (100, {"sent_late_s": 0.1}, True),
        (100, {"cpu_wait_s": 0.04, "sent_late_s": 0.04}, True),
    ],
)
def test_a_loss_is_a_false_alarm_unless_the_machine_may_have_caused_it(
    number: int, delays: Delays, excused: bool
) -> None:
    verdict = judge_jumps(with_delays(jump(LOSES_100()), number, **delays), steady(RIGHT()))
    assert_undecided(verdict) if excused else assert_failed(verdict, "false alarm")


@pytest.mark.parametrize(("cpu_wait_s", "excused"), [(0.0, False), (0.02, False), (0.1, True)])
def test_a_count_that_lacks_a_message_is_undecided_where_the_node_may_have_lost_it(
    cpu_wait_s: float, excused: bool
) -> None:
    counted = judge_slow_count(steady(RIGHT()), with_delays(jump(LOSES_100()), 100, cpu_wait_s=cpu_wait_s))
    assert_undecided(counted) if excused else assert_failed(counted, "off by one")
    restarted = with_delays(restart(LOSES_8()), 8, cpu_wait_s=cpu_wait_s)
    verdict = judge_new_publisher(restarted, steady(RIGHT()), jump(RIGHT()))
    assert_undecided(verdict) if excused else assert_failed(verdict, "wrong count after a restart")


def test_a_count_that_always_lacks_one_is_off_by_one_on_any_machine() -> None:
    always = (
        with_delays(steady(ONE_TOO_FEW()), 3, cpu_wait_s=0.1),
        with_delays(jump(ONE_TOO_FEW()), 100, cpu_wait_s=0.1),
    )
    assert_failed(judge_slow_count(*always), "off by one")


@pytest.mark.parametrize("cpu_wait_s", [0.0, 0.02, 2.0])
def test_a_warning_about_one_gap_does_not_cover_the_other(cpu_wait_s: float) -> None:
    skips_the_first = node(gap=lambda node: MISSING if node.gaps > 1 else ())
    jump_trial = jump_twice(skips_the_first(), cpu_wait_s=cpu_wait_s)
    assert_failed(judge_jumps(jump_trial, steady(skips_the_first())), "gap not noticed")


@pytest.mark.parametrize(
    ("text", "passes"), [("2 gaps", True), (f"{LEFT_OUT[0] + 1} numbers are missing", True), ("a gap", False)]
)
def test_one_message_may_cover_both_gaps_if_the_node_was_starved(text: str, passes: bool) -> None:
    jump_trial, steady_trial = jump_twice(RIGHT()), steady(RIGHT())
    logs = [log for log in jump_trial.trace.logs if "missing" not in log.text]
    assert len(logs) == len(jump_trial.trace.logs) - 2
    both = with_trace(jump_trial, logs=(*logs, logged(text, jump_trial.sent[SECOND_JUMP_AFTER].at + 0.1, 30)))
    assert_failed(judge_jumps(both, steady_trial), "gap not noticed")
    verdict = judge_jumps(replace(both, cpu_wait_s=0.5), steady_trial)
    assert verdict.passed == passes, verdict


@pytest.mark.parametrize("cpu_wait_s", [0.0, 2.0])
@pytest.mark.parametrize(("first", "late_s"), [(91, LATE_S), (92, LATE_S), (92, 0.124), (90, LATE_S)])
def test_an_alarm_next_to_a_summary_is_not_one_of_its_lines(first: int, late_s: float, cpu_wait_s: float) -> None:
    compares_texts = node(
        heard=lambda node: [(30, "out of sequence")] if node.data < node.last else (), gap="out of sequence"
    )
    jump_trial, steady_trial = jump(compares_texts(), first=first), steady(compares_texts())
    alarm = next(log for log in jump_trial.trace.logs if log.text == "out of sequence")
    late = logged(alarm.text, alarm.stamp + late_s, 30)
    jump_trial = with_trace(jump_trial, logs=tuple(late if log is alarm else log for log in jump_trial.trace.logs))
    jump_trial = replace(jump_trial, cpu_wait_s=cpu_wait_s)
    assert_passed(judge_slow_summary(steady_trial, jump_trial))
    assert_passed(judge_slow_count(steady_trial, jump_trial))
    assert_failed(judge_jumps(jump_trial, steady_trial), "false alarm")


def test_a_first_message_delayed_by_the_machine_excuses_a_higher_rate() -> None:
    """The kernel reports a delay of half a second, so the node saw 10 messages in 1.3 s."""
    first_message_late = node(rating=lambda node: node.count / (node.times[-1] - node.begin - 0.5))
    steady_trial, jump_trial = steady(first_message_late()), jump(first_message_late())
    owed = [0.0, 0.25, *[0.5] * 18]
    excused = tuple(replace(sent, cpu_wait_s=late_s) for sent, late_s in zip(steady_trial.sent, owed, strict=True))
    assert_failed(judge_stated_rate(steady_trial, jump_trial), "wrong rate")
    assert_passed(judge_stated_rate(replace(steady_trial, sent=excused, cpu_wait_s=0.5), jump_trial))


def test_a_pace_at_which_truncated_seconds_look_right_is_undecided() -> None:
    cut = node(
        rating=lambda node: node.count / max(1, int(node.times[-1] - node.begin)),
        summary="{count} | {rate} | {first} | {last}",
    )
    assert_undecided(judge_stated_rate(steady(cut(), 4.4), jump(cut())))
    assert_passed(judge_stated_rate(steady(RIGHT(), 4.4), jump(RIGHT())))


@pytest.mark.parametrize(
    ("rating", "late_s"),
    [
        (lambda node: node.count / (node.times[-1] - node.begin + 0.8), 0.35),
        (lambda node: node.count / int(node.times[-1] - node.begin + 0.2), 0.2),
    ],
    ids=["since its start", "per whole second of late messages"],
)
def test_a_wrong_rate_of_a_summary_that_the_machine_delays_is_undecided(
    rating: Callable[[FakeStats], float], late_s: float
) -> None:
    wrong, right = node(rating=rating), RIGHT
    for make, judged in ((wrong, assert_undecided), (right, assert_passed)):
        judged(judge_stated_rate(steady(make(), late_s=late_s, cpu_wait_s=0.5), jump(make())))


def test_the_longest_delay_in_sending() -> None:
    late = steady(RIGHT())
    late = replace(late, sent=tuple(replace(sent, at=sent.at + 0.4 * (sent.number > 12)) for sent in late.sent))
    assert steady(RIGHT()).max_delay_s == pytest.approx(0.0, abs=1e-6)
    assert late.max_delay_s == pytest.approx(0.4, abs=1e-3)
    assert restart(RIGHT()).max_delay_s == pytest.approx(0.0, abs=1e-6), "the absence of a publisher is not a delay"
    assert Trial(trace()).max_delay_s == 0.0
