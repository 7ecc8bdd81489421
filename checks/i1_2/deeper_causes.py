"""I1.2: root causes of several failures, which a single failure does not reveal."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import wraps

from checks.i1_2 import backlog, slowness
from checks.i1_2.facts import TOPIC, TYPE, Trial
from tutor.judge import causes, edits, source
from tutor.judge.causes.inheritance import diagnose_repeated_setup
from tutor.judge.rewriting.node import argument
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, Status, Verdict

_CAUSED_BY_RESETS = (
    "wrong count",
    "first message overwritten",
    "starts over silently",
    "wrong count after a restart",
)
"""Causes, by their names, of which a reset where N only rises may be the root."""


def with_deeper_cause[V: Verdict | None](judge: Callable[..., V]) -> Callable[..., V]:
    """Decorate a judge: its failures get another cause if the trials reveal a deeper one."""

    @wraps(judge)
    def judged(*trials: Trial) -> V:
        verdict = judge(*trials)
        if (
            verdict is None
            or verdict.status is not Status.FAILED
            or any(causes.diagnose_process(each.trace) for each in trials)
        ):
            return verdict
        cause = _diagnose_double_count(trials) or _diagnose_own_messages(trials) or _diagnose_waiting(trials)
        if cause is None and verdict.cause.partition(":")[0] in _CAUSED_BY_RESETS:
            cause = _diagnose_text_comparison(trials)
        return verdict if cause is None else replace(verdict, cause=str(cause), hint=cause.hint)

    return judged


def _diagnose_waiting(trials: Sequence[Trial]) -> Cause | None:
    """Find what the node waits for, if it handles messages late or not at all and its source shows why."""
    for trial in trials:
        if behind := backlog.messages_behind(trial):
            text = f"it handles a message when {behind} newer ones have come, or never"
        elif not trial.first_publisher_left_at and any(backlog.find_lost(trial, each) for each in trials):
            text = "some messages never reach its callback"
        elif trial.sent and trial.spins and not trial.lines:
            text = "it is not done with its messages in time"
        else:
            continue
        if (cause := slowness.diagnose_waits(trial.trace, text)) is not None:
            return cause
    return None


def _diagnose_double_count(trials: Sequence[Trial]) -> Cause | None:
    """Find two subscriptions that count each message twice."""
    for trial in trials:
        ours = [each for each in trial.trace.graph.subscriptions if (each.topic, each.type) == (TOPIC, TYPE)]
        if len(ours) < 2 or not _has_doubled_count(trial):
            continue
        if (repeated := diagnose_repeated_setup(trial.trace, "create_subscription")) is not None:
            return repeated
        calls = source.calls(trial.trace, "create_subscription")
        line_numbers = [call.lineno for call in calls]
        where = f": lines {' and '.join(map(str, line_numbers))}" if len(line_numbers) > 1 else ""
        return Cause(
            "two subscriptions",
            f"{len(ours)} subscriptions on {TOPIC} each call the callback, so that every message counts twice{where}",
            next(filter(None, (slowness.remove_call(trial.trace, call) for call in reversed(calls))), "")
            or f"keep one of them, and take the one in line {line_numbers[-1]} out"
            if len(line_numbers) > 1
            else "make one node, and one subscription in it",
        )
    return None


def _diagnose_own_messages(trials: Sequence[Trial]) -> Cause | None:
    """Find a publisher of the node's own, whose messages it counts as well."""
    for trial in trials:
        own = [each for each in trial.trace.graph.publishers if (each.topic, each.type) == (TOPIC, TYPE)]
        if own and any(line.numbers for line in trial.lines):
            calls = [each for each in source.calls(trial.trace, "publish") if _is_on_topic(trial.trace, each)]
            steps = (slowness.remove_call(trial.trace, call) for call in calls)
            return Cause(
                "own messages",
                f"{own[0].node} itself publishes on {TOPIC}, and so counts its own messages, too",
                next(filter(None, steps), "") or f"remove the publisher on {TOPIC}",
            )
    return None


def _is_on_topic(trace: Trace, call: ast.Call) -> bool:
    """Whether a call of publish() is of a publisher that is made with the same topic as a subscription."""
    file = source.file_holding(trace, call)
    heard = {ast.unparse(topic) for each in file.calls("create_subscription") if (topic := argument(each, 1, "topic"))}
    publishers = [
        file.assigned_to(each)
        for each in file.calls("create_publisher")
        if (topic := argument(each, 1, "topic")) is not None
        and (ast.unparse(topic) in heard or (isinstance(topic, ast.Constant) and topic.value in (TOPIC, TOPIC[1:])))
    ]
    return isinstance(call.func, ast.Attribute) and ast.unparse(call.func.value) in publishers


def _diagnose_text_comparison(trials: Sequence[Trial]) -> Cause | None:
    """Find a comparison that tells a restart by the texts of two messages, not by their numbers."""
    trace = next((trial.trace for trial in trials if trial.trace.sources), None)
    if trace is None:
        return None
    kept = {
        target for target, value in _assignments(trace) if isinstance(value, ast.Attribute) and value.attr == "data"
    }
    for function in source.callbacks(trace, "create_subscription"):
        for node in ast.walk(function):
            if not isinstance(node, ast.Compare) or not isinstance(node.ops[0], ast.Lt | ast.LtE | ast.Gt | ast.GtE):
                continue
            operands = (node.left, *node.comparators)
            if len(operands) == 2 and all(_is_text(each, kept) for each in operands):
                numbers = [(each, f"int({ast.unparse(each)}.rpartition(':')[2] or -1)") for each in operands]
                file = source.file_holding(trace, node)
                return Cause(
                    "texts compared",
                    f"{source.where(node)} compares texts, and as texts, “Hello World: 10” is less than "
                    "“Hello World: 9”",
                    edits.describe_edits_of(file, edits.replace_nodes(file.text, *numbers)) or "",
                )
    return None


def _assignments(trace: Trace) -> list[tuple[str, ast.expr]]:
    nodes = [node for node in source.all_nodes(trace) if isinstance(node, ast.Assign)]
    return [(ast.unparse(target), node.value) for node in nodes for target in node.targets]


def _is_text(operand: ast.expr, kept: set[str]) -> bool:
    """Whether an operand is a message's text: `msg.data`, or a variable in `kept` that holds one."""
    return (isinstance(operand, ast.Attribute) and operand.attr == "data") or ast.unparse(operand) in kept


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
