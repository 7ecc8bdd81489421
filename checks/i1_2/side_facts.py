"""I1.2: what the trials show beside what one criterion judges: late messages, each counted twice, or one's own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import wraps
from typing import Any

from checks.i1_2 import backlog, losses
from checks.i1_2.facts import TOPIC, TYPE, Trial
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Failure, Verdict


def with_side_facts[V: Verdict | None](judge: Callable[..., V]) -> Callable[..., V]:
    """Decorate a judge: what its failures have seen also tells what else the trials show."""

    @wraps(judge)
    def judged(*trials: Trial) -> V:
        verdict = judge(*trials)
        if not isinstance(verdict, Failure) or any(each.trace.exit is not None for each in trials):
            return verdict
        seen = verdict.seen
        if seen is None or seen.symptom not in (Symptom.WRONG_LOG, Symptom.NOT_LOGGED):
            return verdict
        return replace(verdict, seen=replace(seen, about={**seen.about, **_find_facts(trials)}))

    return judged


def _find_facts(trials: Sequence[Trial]) -> dict[str, Any]:
    """The facts that are so: `late`, in words, and whether it is `surely_late`, whatever it counts; `own_publisher`.

    `subscriptions`, if each message counts twice; `renewals` of its subscription.
    """
    facts: dict[str, Any] = {"topic": TOPIC, "type": TYPE}
    for trial in trials:
        ours = [each for each in trial.trace.graph.subscriptions if (each.topic, each.type) == (TOPIC, TYPE)]
        if len(ours) > 1 and _has_doubled_count(trial):
            facts["subscriptions"] = len(ours)
        own = [each for each in trial.trace.graph.publishers if (each.topic, each.type) == (TOPIC, TYPE)]
        if own and any(line.numbers for line in trial.lines):
            facts["own_publisher"] = own[0].node
        if losses.renews_subscription(trial):
            facts["renewals"] = trial.new_subscriptions
        if (late := _find_delay(trial, trials)) and "late" not in facts:
            facts["late"] = late
        # A wrong count looks like lost messages, and a node that says nothing may well be prompt.
        facts["surely_late"] = facts.get("surely_late", False) or backlog.messages_behind(trial) > 0
    return facts


def _find_delay(trial: Trial, trials: Sequence[Trial]) -> str:
    """How the node handles messages late or not at all, in words; "" if it keeps up."""
    if behind := backlog.messages_behind(trial):
        return f"a message is handled when {behind} newer ones have come, or never"
    rises = not trial.first_publisher_left_at and not trial.jumps
    if rises and any(backlog.find_lost(trial, each) for each in trials):
        return "some messages never reach the callback"
    if trial.sent and trial.spins and not trial.lines:
        return "the node is not done with its messages in time"
    return ""


def _has_doubled_count(trial: Trial) -> bool:
    """Whether a number in the log is always twice the number of messages sent."""
    for kind in {line.kind for line in trial.lines}:
        lines = [line for line in trial.lines if line.kind == kind and line.numbers]
        for place in range(min((len(line.numbers) for line in lines), default=0)):
            if len(lines) > 1 and all(
                2 * line.messages - 1 <= line.numbers[place].value <= 2 * line.messages for line in lines
            ):
                return True
    return False
