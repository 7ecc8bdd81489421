"""I1.2: one cause behind several failures, which the failures themselves do not tell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import wraps

from checks.i1_2 import backlog, slowness
from checks.i1_2.facts import TOPIC, TYPE, Feeding
from tutor.judge import causes, source
from tutor.judge.verdict import Cause, Status, Verdict

Judge = Callable[..., Verdict]


def explained(judge: Judge) -> Judge:
    """The judge, with another cause for its failures where what was fed shows one that lies deeper."""

    @wraps(judge)
    def judged(*feedings: Feeding) -> Verdict:
        verdict = judge(*feedings)
        if verdict.status is not Status.FAILED or any(causes.of_process(each.trace) for each in feedings):
            return verdict
        cause = _counted_twice(feedings) or _kept_waiting(feedings)
        return verdict if cause is None else replace(verdict, cause=str(cause), hint=cause.hint)

    return judged


def _kept_waiting(feedings: Sequence[Feeding]) -> Cause | None:
    """Whether it takes in messages late, or not at all, and its source says what it waits for meanwhile."""
    for feeding in feedings:
        if behind := backlog.behind(feeding):
            text = f"it takes in a message when {behind} newer ones have come, or never"
        elif any(backlog.lost(feeding, each) for each in feedings):
            text = "some messages never reach its callback"
        elif feeding.sent and feeding.spins and not feeding.lines:
            text = "it is not done with its messages in time"
        else:
            continue
        if (cause := slowness.of_waits(feeding.trace, text)) is not None:
            return cause
    return None


def _counted_twice(feedings: Sequence[Feeding]) -> Cause | None:
    """Whether two subscriptions count each message twice."""
    for feeding in feedings:
        here = [each for each in feeding.trace.graph.subscriptions if (each.topic, each.type) == (TOPIC, TYPE)]
        if len(here) < 2 or not _doubled(feeding):
            continue
        calls = source.calls(feeding.trace, "create_subscription")
        made = [call.lineno for call in calls]
        where = f": lines {' and '.join(map(str, made))}" if len(made) > 1 else ""
        return Cause(
            "two subscriptions",
            f"{len(here)} subscriptions on {TOPIC} each call the callback, so that every message counts twice{where}",
            next(filter(None, (slowness.without(feeding.trace, call) for call in reversed(calls))), "")
            or f"keep one of them, and take the one in line {made[-1]} out"
            if len(made) > 1
            else "make one node, and one subscription in it",
        )
    return None


def _doubled(feeding: Feeding) -> bool:
    """Whether a number in its log is twice what was sent, each time."""
    for kind in {line.kind for line in feeding.lines}:
        lines = [line for line in feeding.lines if line.kind == kind and line.numbers]
        for place in range(min((len(line.numbers) for line in lines), default=0)):
            if len(lines) > 1 and all(
                2 * line.messages - 1 <= line.numbers[place].value <= 2 * line.messages for line in lines
            ):
                return True
    return False
