"""A form: an action server handles a goal: it accepts or rejects it, sends feedback, and ends it with a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import GOAL_SERVICE, GOAL_TYPE, Action, Program, agrees, show
from tutor.exercise.seen_run import Seen, look, settle
from tutor.judge.bench import Bench, GoalClient, Run
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import GoalAnswer
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.waiting_for_nodes import IDLE_S, RESENT_S, patience_s, wait_until_seen
from tutor.judge.wording import counted, output_tail

ANSWER_S = 5.0
"""Time limit for the answer to a goal, and to a request to cancel it."""

Outcome = Literal["succeeded", "aborted", "canceled", "rejected"]
"""How a goal ends."""

_STEPS = {
    "succeeded": "Call succeed() on the goal handle before the callback returns its result.",
    "aborted": "Call abort() on the goal handle before the callback returns its result.",
    "canceled": "Look at is_cancel_requested while the goal runs; then call canceled() on its handle, and return.",
    "rejected": "Give the action server a goal_callback that returns GoalResponse.REJECT for such a goal.",
}


@dataclass(frozen=True)
class GoalRun(Seen):
    """What became of a goal that we sent. `answer`: None if there was no action server."""

    answer: GoalAnswer | None = None


async def wait_for_server(run: Run, action: Action, client: GoalClient) -> bool:
    """Wait until our client and the action server know each other."""
    name, kind = action.goal_service
    there = await wait_until_seen(
        run,
        lambda: client.matched,
        promised=lambda: action.has_server(run.graph),
        message_gap_s=RESENT_S,
        settle_s=lambda: patience_s(((server.name, server.type) for server in run.graph.servers), name, kind),
    )
    if there:
        await settle(run)  # otherwise the first feedback may be lost
    return there


async def pursue(
    run: Run, client: GoalClient, goal: Mapping[str, Any], cancel_after: int | None, limit_s: float
) -> None:
    """Send a goal, and wait for how it ends. `cancel_after`: ask to cancel it after so many feedback messages."""

    def is_over() -> bool:
        return bool(client.seen.outcome) or client.seen.accepted is False

    client.send(goal)
    await run.until(lambda: client.seen.accepted is not None, ANSWER_S, idle_s=RESENT_S)
    if not client.seen.accepted:
        return
    if cancel_after is not None:
        await run.until(lambda: is_over() or len(client.seen.feedback) >= cancel_after, limit_s, idle_s=RESENT_S)
        if not is_over():
            client.cancel()
            await run.until(lambda: client.seen.cancel_accepted is not None, ANSWER_S, idle_s=RESENT_S)
    await run.until(is_over, limit_s, idle_s=RESENT_S)


@dataclass(frozen=True)
class SendGoal:
    """Start without parameters, and send a goal; see `pursue`. `feedback`: how many messages of it are waited for."""

    program: Program
    action: Action
    goal: Mapping[str, Any] = field(hash=False)
    feedback: int
    cancel: bool
    within_s: float

    async def __call__(self, bench: Bench) -> GoalRun:
        action = self.action
        async with (
            bench.start(self.program.file, expected_s=2.0) as run,
            run.goal_client(action.name, action.type) as client,
        ):
            bench.report_progress(0.1, f"waiting for the action server of {action.name}")
            if not await wait_for_server(run, action, client):
                return (await look(run, does_nothing=True)).having(GoalRun)
            bench.report_progress(0.4, f"sending a goal to {action.name}")
            await pursue(run, client, self.goal, self.feedback if self.cancel else None, self.within_s)
            # Feedback and result come on different ways: the last feedback may come after the result.
            await run.until(lambda: len(client.seen.feedback) >= self.feedback, IDLE_S)
            answer = client.seen
            return (await look(run, does_nothing=not answer.accepted)).having(GoalRun, answer=answer)


@dataclass(frozen=True)
class HandlesGoal(Form):
    """An action server handles a goal as it should: it accepts it, sends feedback, and ends it with a result.

    `goal`: its fields and their values. `ends`: "succeeded", "aborted", "rejected", or "canceled", where we ask for
    that once it is accepted and the feedback is there. `feedback`: how many messages of it must come at least.
    `result`: those of its fields that matter, with their values. `within_s`: how long the goal may take, in seconds.

        HandlesGoal("counts", FIBONACCI, {"order": 5}, feedback=1, result={"sequence": [0, 1, 1, 2, 3, 5]})
        HandlesGoal("stops", FIBONACCI, {"order": 50}, ends="canceled", feedback=2)
    """

    action: Action
    goal: Mapping[str, Any] = field(hash=False)
    ends: Outcome = "succeeded"
    feedback: int = 0
    result: Mapping[str, Any] | None = field(default=None, hash=False)
    within_s: float = 10.0

    def __post_init__(self) -> None:
        if self.ends not in _STEPS:
            raise ValueError(f"{self.id}: {self.ends!r} is no end of a goal: take one of {', '.join(_STEPS)}")

    def criterion(self, exercise: Exercise) -> Criterion:
        canceled, within_s = self.ends == "canceled", 0.0 if self.ends == "rejected" else self.within_s
        scenario = SendGoal(exercise.program, self.action, self.goal, self.feedback, canceled, within_s)
        return self.judged(self.judge, scenario)

    def judge(self, found: GoalRun) -> Verdict:
        """Judge what became of the goal."""
        action, answer = self.action, found.answer
        asked = f"{action.name} {' '.join(f'{name}={show(value)}' for name, value in self.goal.items())}".rstrip()
        parts = [f"{asked} is {self.ends}"]
        parts += [f"after {counted(self.feedback, 'feedback message')}"] if self.feedback else []
        parts += [f"with {dict(self.result)}"] if self.result else []
        expected = " ".join(parts)
        tail = output_tail(found.trace)
        if answer is None:
            return failed(expected, f"{action.name} has no action server", action_missing(action, found), tail)
        trail = [str(dict(feedback.message)) for feedback in answer.feedback[:3]]
        observed, why = self._what_is_wrong(found, answer)
        if why is not None:
            return failed(expected, observed, why, [*trail, *tail])
        return passed(expected, observed, trail)

    def _what_is_wrong(self, seen: Seen, answer: GoalAnswer) -> tuple[str, Observation | None]:
        """What was observed, and the failure, if it is one."""

        def wrong(observed: str, do: str) -> tuple[str, Observation]:
            about = {"action": self.action.name, "wanted": self.ends, "found": outcome}
            return observed, seen.symptom(Symptom.WRONG_GOAL, says=observed, do=do, **about)

        outcome = "rejected" if answer.accepted is False else answer.outcome
        if self.ends == "canceled" and answer.cancel_accepted is False:
            do = "Give the action server a cancel_callback that returns CancelResponse.ACCEPT."
            return wrong("it is accepted, and our request to cancel it is not", do)
        if answer.accepted is None or (not outcome and self.ends != "rejected"):
            return unanswered(self.action, seen, answer, self.within_s)
        if outcome != self.ends:
            ended = "it is accepted" if self.ends == "rejected" else f"it is {outcome}"
            accept = "Let the goal_callback return GoalResponse.ACCEPT for it."
            return wrong(f"{ended}, not {self.ends}", accept if outcome == "rejected" else _STEPS[self.ends])
        if len(answer.feedback) < self.feedback:
            do = "Call publish_feedback() on the goal handle while the goal runs."
            return wrong(f"{self.ends} with {counted(len(answer.feedback), 'feedback message')}", do)
        if self.result is not None and not agrees(answer.result, self.result):
            return wrong(
                f"{self.ends} with {dict(answer.result or {})}, not {dict(self.result)}",
                "Look at what the callback puts into the result before it returns it.",
            )
        return f"{self.ends}, {counted(len(answer.feedback), 'feedback message')}, {dict(answer.result or {})}", None


def action_missing(action: Action, seen: Seen) -> Observation:
    """There is no server of this action; others may be there."""
    services = [(server.name, server.type) for server in seen.trace.graph.servers if server.name.endswith(GOAL_SERVICE)]
    others = [f"{name.removesuffix(GOAL_SERVICE)} of type {kind.removesuffix(GOAL_TYPE)}" for name, kind in services]
    says = f"there is an action server {' and '.join(others)}, but none {action.name} of type {action.type}"
    return seen.symptom(Symptom.ACTION_MISSING, action=action.name, type=action.type, says=says if others else "")


def unanswered(action: Action, seen: Seen, answer: GoalAnswer, within_s: float) -> tuple[str, Observation]:
    """What was observed of a goal without an answer or an end, and the failure."""
    says, do = f"{action.name} does not answer a goal", "Look at what its goal_callback waits for."
    if answer.accepted:
        says = f"{action.name} accepts the goal, and does not end it within {within_s:g} s"
        do = "Follow the execute callback to where it stays, and let it return its result."
    return says, seen.symptom(Symptom.NO_ANSWER, action=action.name, type=action.type, says=says, do=do)
