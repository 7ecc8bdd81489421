"""I1.2: what a busy machine may explain is not held against a node, and everything else is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from checks.i1_2_message_statistics.gaps import judge_jumps
from checks.i1_2_message_statistics.trial import Trial
from tests.checks import statistics_nodes as nodes
from tests.checks.builders import assert_passed, assert_undecided, trace
from tests.checks.statistics_nodes import RIGHT, FakeStats, node
from tests.checks.statistics_trials import Trials, assert_failed, restart, slowly
from tutor.judge.verdict import Verdict

LOSES_100 = node(takes=lambda node: node.incoming != 100)
"""Does not receive N = 100: the next message was in its queue of one before it was read."""

LOSES_8 = node(takes=lambda node: node.incoming != 8)


def with_delays(trial: Trial, number: int, *, sent_late_s: float = 0.0, cpu_wait_s: float = 0.0) -> Trial:
    """The trial with this N sent late, and the node waiting for a CPU while it came."""
    sent = [
        replace(
            message,
            at=message.at + sent_late_s * (message.number == number),
            cpu_wait_s=message.cpu_wait_s + cpu_wait_s * (message.number > number),
        )
        for message in trial.sent
    ]
    return replace(trial, sent=tuple(sent))


def assert_excused(verdict: Verdict, excused: bool, cause: str) -> None:
    """Fail unless the verdict is undecided, or else failed with this cause."""
    assert_undecided(verdict) if excused else assert_failed(verdict, cause)


@pytest.mark.parametrize(
    ("number", "sent_late_s", "cpu_wait_s", "excused"),
    [
        (100, 0.0, 0.0, False),
        (103, 0.0, 0.1, False),
        (100, 0.0, 0.1, True),
        (100, 0.1, 0.0, True),
        (100, 0.04, 0.04, True),
    ],
)
def test_a_loss_is_a_false_alarm_unless_the_machine_may_have_caused_it(
    number: int, sent_late_s: float, cpu_wait_s: float, excused: bool
) -> None:
    jump = with_delays(slowly(LOSES_100).jump, number, sent_late_s=sent_late_s, cpu_wait_s=cpu_wait_s)
    assert_excused(judge_jumps(jump, slowly(RIGHT).steady), excused, "false alarm")


@pytest.mark.parametrize(("cpu_wait_s", "excused"), [(0.0, False), (0.02, False), (0.1, True)])
def test_a_count_of_one_fewer_is_undecided_where_the_node_may_have_lost_that_message(
    cpu_wait_s: float, excused: bool
) -> None:
    jump = with_delays(slowly(LOSES_100).jump, 100, cpu_wait_s=cpu_wait_s)
    assert_excused(replace(slowly(RIGHT), jump=jump).judge("count"), excused, "off by one")
    restarted = with_delays(restart(LOSES_8()), 8, cpu_wait_s=cpu_wait_s)
    verdict = replace(slowly(RIGHT), restart=restarted).judge("restart")
    assert_excused(verdict, excused, "wrong count after a restart")


def test_a_count_of_one_fewer_is_wrong_if_it_always_is() -> None:
    trials = slowly(nodes.ONE_TOO_FEW)
    starved = (with_delays(trial, n, cpu_wait_s=0.1) for trial, n in ((trials.steady, 3), (trials.jump, 100)))
    assert_failed(Trials(*starved).judge("count"), "off by one")


def test_a_first_message_delayed_by_the_machine_excuses_a_higher_rate() -> None:
    """The kernel reports a delay of half a second, so the node saw 10 messages in 1.3 s."""
    trials = slowly(node(rating=lambda node: node.count / (node.elapsed_s - 0.5)))
    assert_failed(trials.judge("rate"), "wrong rate")
    owed = [0.0, 0.25, *[0.5] * 18]
    sent = tuple(replace(sent, cpu_wait_s=late_s) for sent, late_s in zip(trials.steady.sent, owed, strict=True))
    assert_passed(replace(trials, steady=replace(trials.steady, sent=sent, cpu_wait_s=0.5)).judge("rate"))


def test_a_higher_rate_of_the_last_five_is_undecided_if_the_machine_delayed_one_of_them() -> None:
    """The sixth message came 0.4 s late, so the node saw the last five of ten in less time."""
    trials = slowly(node(rating=lambda node: 4 / (4 / 4.95 - 0.4 * (node.count == 10))))
    assert_failed(trials.judge("rate"), "wrong rate")
    owed = [*[0.0] * 6, 0.2, *[0.4] * 13]
    sent = tuple(replace(sent, cpu_wait_s=late_s) for sent, late_s in zip(trials.steady.sent, owed, strict=True))
    assert_undecided(replace(trials, steady=replace(trials.steady, sent=sent, cpu_wait_s=0.4)).judge("rate"))


def test_a_pace_at_which_truncated_seconds_look_right_is_undecided() -> None:
    cut = node(
        rating=lambda node: node.count / max(1, int(node.elapsed_s)), summary="{count} | {rate} | {first} | {last}"
    )
    assert_undecided(slowly(cut, hz=4.4).judge("rate"))
    assert_passed(slowly(RIGHT, hz=4.4).judge("rate"))


@pytest.mark.parametrize(
    ("rating", "late_s"),
    [
        (lambda node: node.count / (node.elapsed_s + 0.8), 0.35),
        (lambda node: node.count / int(node.elapsed_s + 0.2), 0.2),
    ],
    ids=["since its start", "per whole second of late messages"],
)
def test_a_wrong_rate_of_a_summary_that_the_machine_delays_is_undecided(
    rating: Callable[[FakeStats], float], late_s: float
) -> None:
    for make, judged in ((node(rating=rating), assert_undecided), (RIGHT, assert_passed)):
        late, calm = slowly(make, late_s=late_s, cpu_wait_s=0.5), slowly(make)
        judged(replace(late, jump=calm.jump).judge("rate"))


def test_the_longest_delay_in_sending() -> None:
    prompt = slowly(RIGHT).steady
    late = tuple(replace(sent, at=sent.at + 0.4 * (sent.number > 12)) for sent in prompt.sent)
    assert prompt.max_delay_s == pytest.approx(0.0, abs=1e-6)
    assert replace(prompt, sent=late).max_delay_s == pytest.approx(0.4, abs=1e-3)
    assert restart(RIGHT()).max_delay_s == pytest.approx(0.0, abs=1e-6), "the absence of a publisher is not a delay"
    assert Trial(trace()).max_delay_s == 0.0
