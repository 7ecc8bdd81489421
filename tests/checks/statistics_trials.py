"""I1.2: what is observed of a fake statistics node on a simulated clock, and the verdicts on it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from checks.i1_2_message_statistics import CHECK, plans
from checks.i1_2_message_statistics.count import judge_fast_count
from checks.i1_2_message_statistics.plans import FAST_HZ, FAST_MESSAGES, JUMP_AFTER, LEFT_OUT
from checks.i1_2_message_statistics.summary import judge_fast_summary
from checks.i1_2_message_statistics.trial import Sent, Trial
from tests.checks import builders
from tests.checks.builders import NODE_UP, START, assert_passed, explained, judge_of, trace
from tests.checks.statistics_nodes import FakeStats, Log, Make
from tutor.judge.trace import LogRecord
from tutor.judge.verdict import Status, Verdict
from tutor.ros_model import TopicEndpoint

LISTENING = replace(NODE_UP, subscriptions=(TopicEndpoint("/chatter", "std_msgs/msg/String", "/node"),))
LATE_S = 0.0005


def logged(text: str, at: float = START, level: int = 20) -> LogRecord:
    return LogRecord(level, "node", text, at, at)


def feed(
    node: FakeStats,
    numbers: Sequence[int],
    hz: float,
    *,
    breaks: tuple[int, ...] = (),
    away_s: float = 0.0,
    late_s: float = LATE_S,
    slow_s: float = 0.0,
    between_s: float = 0.0002,
    **facts: Any,
) -> Trial:
    """The trial that is observed when messages with these numbers are sent to the node.

    `breaks`: indexes of the first messages after a jump or restart, before the first of which the publisher is away for
    `away_s`. `late_s`: delay from a message to its first log message. `between_s`: delay between two log messages of
    one message. `slow_s`: further delay of the summaries.
    """
    summaries: list[Log] = []
    sum_up = node.sum_up

    def record_summary() -> Iterator[Log]:
        summaries[:] = sum_up()
        yield from summaries

    node.sum_up = record_summary  # type: ignore[method-assign]
    sent: list[Sent] = []
    logs: list[LogRecord] = []
    for index, number in enumerate(numbers):
        at = START + 1 + index / hz + (away_s if breaks and index >= breaks[0] else 0.0)
        sent.append(Sent(number, at))
        summaries.clear()
        for order, log in enumerate(list(node.receive(at + 0.0004, f"Hello World: {number}"))):
            logs.append(logged(log[1], at + late_s + order * between_s + slow_s * (log in summaries), log[0]))
    gone_at = sent[breaks[0] - 1].at + 0.2 if away_s else 0.0
    return replace(Trial(trace(graph=LISTENING, logs=logs), tuple(sent), breaks, gone_at), **facts)


def fast(node: FakeStats, *, first: int = 7, messages: int = FAST_MESSAGES, hz: float = FAST_HZ, **how: Any) -> Trial:
    return feed(node, range(first, first + messages), hz, **how)


def restart(node: FakeStats, **how: Any) -> Trial:
    before, after = plans.RESTART_AFTER, plans.RESTART_MESSAGES - plans.RESTART_AFTER
    return feed(node, [*range(4, 4 + before), *range(after)], 8.0, breaks=(before,), away_s=1.5, **how)


SCENARIOS = {
    "count": ("steady", "jump", "fast"),
    "rate": ("steady", "jump", "restart", "fast"),
    "summary": ("steady", "jump", "fast"),
    "restart": ("steady", "jump", "restart", "fast"),
    "gaps": ("steady", "jump", "jump_twice", "jump_after_zero", "restart", "fast"),
    "shutdown": ("fast",),
}
"""The trials by which each criterion is judged."""

NOTHING = Trial(trace())
"""A trial in which nothing was sent: a judge then judges by the others."""


@dataclass(frozen=True)
class Trials:
    """What is observed of a node in all scenarios."""

    steady: Trial
    jump: Trial
    jump_twice: Trial = NOTHING
    jump_after_zero: Trial = NOTHING
    restart: Trial = NOTHING
    fast: Trial = NOTHING

    def judge(self, criterion: str) -> Verdict:
        """The verdict on a criterion, with the mistake that explains it."""
        trials = (getattr(self, scenario) for scenario in SCENARIOS[criterion])
        return explained(judge_of(CHECK, criterion)(*trials), CHECK)


def slowly(make: Make, *, hz: float = 4.95, missed: int = LEFT_OUT[0], first: int = 95, **how: Any) -> Trials:
    """What is observed of such a node, a fresh one in each trial, if messages come slowly, from one publisher.

    `missed`: how many numbers are left out. `first`: the first number of the trials in which N jumps.
    """
    before, between, after = JUMP_AFTER, plans.SECOND_JUMP_AFTER, plans.JUMP_MESSAGES
    numbers = [first + index + missed * (index >= before) for index in range(after)]
    more = [number + (index >= between) for index, number in enumerate(numbers)]
    return Trials(
        feed(make(), range(20), hz, **how),
        feed(make(), numbers, 8.0, breaks=(before,), **how),
        feed(make(), more, 8.0, breaks=(before, between), **how),
    )


def observe(make: Make, source: str = "", subscriptions: int = 1, **how: Any) -> Trials:
    """What is observed of such a node in all scenarios. `source`: of the node, if the judges see it."""
    after_zero = [0, *range(LEFT_OUT[0] + 1, LEFT_OUT[0] + plans.AFTER_ZERO_MESSAGES)]
    zero = feed(make(), after_zero, 8.0, breaks=(1,), **how)
    trials = replace(
        slowly(make, **how), jump_after_zero=zero, restart=restart(make(), **how), fast=fast(make(), **how)
    )
    if not source:
        return trials
    graph = replace(LISTENING, subscriptions=subscriptions * LISTENING.subscriptions)
    facts = {"graph": graph, "sources": {"node.py": source}}
    return Trials(**{scenario: with_trace(trial, **facts) for scenario, trial in vars(trials).items()})


def judge_trials(make: Make, source: str = "", subscriptions: int = 1, **how: Any) -> dict[str, Verdict]:
    """The verdicts on such a node. Where the source is unknown, the early ones must be the same."""
    trials = observe(make, source, subscriptions, **how)
    rated = replace(trials, restart=NOTHING, fast=trials.fast if source else NOTHING)
    verdicts = {name: (rated if name == "rate" else trials).judge(name) for name in SCENARIOS if name != "shutdown"}
    early = {} if source else {"count": judge_fast_count(trials.fast), "summary": judge_fast_summary(trials.fast)}
    for name, verdict in early.items():
        assert verdict is None or verdict.status is verdicts[name].status is Status.FAILED
        assert verdict is None or explained(verdict, CHECK).mistake == verdicts[name].mistake
    return verdicts


def with_trace(trial: Trial, **facts: Any) -> Trial:
    """The trial with these facts in its trace."""
    return replace(trial, trace=replace(trial.trace, **facts))


def with_log(trial: Trial, text: str, at: float, level: int) -> Trial:
    """The trial with one more log message."""
    return with_trace(trial, logs=(*trial.trace.logs, logged(text, at, level)))


def assert_failed(verdict: Verdict | None, cause: str, *words: str) -> None:
    """Fail unless the verdict failed, and the catalogue explains it by this mistake, with these words."""
    builders.assert_failed(verdict, cause, *words, check=CHECK)


def assert_all_passed(verdicts: dict[str, Verdict]) -> None:
    assert {name: str(verdict) for name, verdict in verdicts.items() if not verdict.passed} == {}
    for verdict in verdicts.values():
        assert_passed(verdict)


def assert_breaks(verdicts: dict[str, Verdict], breaks: str) -> None:
    """Fail unless this criterion failed with this cause ("criterion: cause"), and no other criterion failed."""
    criterion, cause = breaks.split(": ", 1)
    assert_failed(verdicts[criterion], cause)
    others = {name: verdict for name, verdict in verdicts.items() if name != criterion}
    assert [str(v) for v in others.values() if v.status not in (Status.PASSED, Status.SKIPPED)] == []
