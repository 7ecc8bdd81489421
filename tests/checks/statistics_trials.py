"""I1.2: what is observed of a fake statistics node on a simulated clock, and the verdicts on it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from checks.i1_2_message_statistics import CHECK
from checks.i1_2_message_statistics.count import judge_count, judge_fast_count
from checks.i1_2_message_statistics.gaps import judge_gaps
from checks.i1_2_message_statistics.plans import (
    AFTER_ZERO_MESSAGES,
    FAST_HZ,
    FAST_MESSAGES,
    JUMP_AFTER,
    JUMP_MESSAGES,
    LEFT_OUT,
    RESTART_AFTER,
    RESTART_MESSAGES,
    SECOND_JUMP_AFTER,
)
from checks.i1_2_message_statistics.rate import judge_rate
from checks.i1_2_message_statistics.restart import judge_restart
from checks.i1_2_message_statistics.summary import judge_fast_summary
from checks.i1_2_message_statistics.trial import Sent, Trial
from tests.checks import builders
from tests.checks.builders import NODE_UP, START, assert_passed, explained, trace
from tests.checks.statistics_nodes import FakeStats, Log, Make
from tutor.judge.trace import LogRecord
from tutor.judge.verdict import Status, Verdict
from tutor.ros_model import TopicEndpoint

LISTENING = replace(NODE_UP, subscriptions=(TopicEndpoint("/chatter", "std_msgs/msg/String", "/node"),))
JUDGES = {criterion.id: criterion.judge for criterion in CHECK.criteria}
LATE_S = 0.0005


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


def logged(text: str, at: float = START, level: int = 20) -> LogRecord:
    return LogRecord(level, "node", text, at, at)


def steady(node: FakeStats, hz: float = 4.95, **more: Any) -> Trial:
    return feed(node, range(20), hz, **more)


def jump(node: FakeStats, missed: int = LEFT_OUT[0], *, first: int = 95, twice: bool = False, **more: Any) -> Trial:
    numbers = list(range(first, first + JUMP_MESSAGES))
    breaks = (JUMP_AFTER, SECOND_JUMP_AFTER) if twice else (JUMP_AFTER,)
    numbers = [n + missed * (n >= numbers[JUMP_AFTER]) + (twice and n >= numbers[SECOND_JUMP_AFTER]) for n in numbers]
    return feed(node, numbers, 8.0, breaks=breaks, **more)


def jump_twice(node: FakeStats, missed: int = LEFT_OUT[0], **more: Any) -> Trial:
    return jump(node, missed, twice=True, **more)


def jump_after_zero(node: FakeStats, missed: int = LEFT_OUT[0], **more: Any) -> Trial:
    return feed(node, [0, *range(missed + 1, missed + AFTER_ZERO_MESSAGES)], 8.0, breaks=(1,), **more)


def restart(node: FakeStats, **more: Any) -> Trial:
    numbers = [*range(4, 4 + RESTART_AFTER), *range(RESTART_MESSAGES - RESTART_AFTER)]
    return feed(node, numbers, 8.0, breaks=(RESTART_AFTER,), away_s=1.5, **more)


def fast(node: FakeStats, **more: Any) -> Trial:
    return feed(node, range(7, 7 + FAST_MESSAGES), FAST_HZ, **more)


NOTHING = Trial(trace())
"""A trial in which nothing was sent, for judges that are to judge by the others."""


def with_trace(trial: Trial, **facts: Any) -> Trial:
    """The trial with these facts in its trace."""
    return replace(trial, trace=replace(trial.trace, **facts))


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


def judge_slow_count(steady: Trial, jump: Trial) -> Verdict:
    return judge_count(steady, jump, NOTHING)


def judge_stated_rate(steady: Trial, jump: Trial, restart: Trial = NOTHING) -> Verdict:
    return judge_rate(steady, jump, restart, NOTHING)


def judge_new_publisher(restart: Trial, steady: Trial, jump: Trial) -> Verdict:
    return judge_restart(steady, jump, restart, NOTHING)


def judge_rising(jump: Trial, jump_twice: Trial, steady: Trial) -> Verdict:
    return judge_gaps(steady, jump, jump_twice, NOTHING, NOTHING, NOTHING)


def explain(verdict: Verdict) -> Verdict:
    """The verdict with the mistake that explains it, if it is a failure."""
    return explained(verdict, CHECK)


def judge_trials(make: Make, source: str = "", subscriptions: int = 1, **how: Any) -> dict[str, Verdict]:
    """The explained verdicts on such a node, a fresh one in each trial. `source`: of the node, if the judges see it."""

    def observed(trial: Callable[..., Trial]) -> Trial:
        seen = trial(make(), **how)
        graph = replace(LISTENING, subscriptions=subscriptions * LISTENING.subscriptions)
        return with_trace(seen, graph=graph, sources={"node.py": source}) if source else seen

    trials = map(observed, (steady, jump, jump_twice, jump_after_zero, restart, fast))
    steady_trial, jump_trial, twice_trial, zero_trial, restart_trial, fast_trial = trials
    rated = (replace(restart_trial, sent=()), fast_trial) if source else (NOTHING, NOTHING)
    verdicts = {
        "count": JUDGES["count"](steady_trial, jump_trial, fast_trial),
        "rate": JUDGES["rate"](steady_trial, jump_trial, *rated),
        "summary": JUDGES["summary"](steady_trial, jump_trial, fast_trial),
        "restart": JUDGES["restart"](steady_trial, jump_trial, restart_trial, fast_trial),
        "gaps": JUDGES["gaps"](steady_trial, jump_trial, twice_trial, zero_trial, restart_trial, fast_trial),
    }
    verdicts = {name: explain(verdict) for name, verdict in verdicts.items()}
    if not source:
        early = {"count": judge_fast_count(fast_trial), "summary": judge_fast_summary(fast_trial)}
        for name, verdict in early.items():
            assert verdict is None or verdict.status is verdicts[name].status is Status.FAILED
            assert verdict is None or explain(verdict).mistake == verdicts[name].mistake
    return verdicts


def assert_failed(verdict: Verdict | None, cause: str, *words: str) -> None:
    """Fail unless the verdict failed, and the catalogue explains it by this mistake, with these words."""
    builders.assert_failed(verdict, cause, *words, check=CHECK)


def assert_all_passed(verdicts: dict[str, Verdict]) -> None:
    assert {name: str(verdict) for name, verdict in verdicts.items() if not verdict.passed} == {}
    for verdict in verdicts.values():
        assert_passed(verdict)


def assert_breaks(verdicts: dict[str, Verdict], criterion: str, cause: str) -> None:
    """Fail unless this criterion failed with this cause, and no other criterion failed."""
    assert_failed(verdicts[criterion], cause)
    others = {name: verdict for name, verdict in verdicts.items() if name != criterion}
    assert [str(v) for v in others.values() if v.status not in (Status.PASSED, Status.SKIPPED)] == []
