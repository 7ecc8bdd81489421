"""Goals that we send to the learner's action server, and what becomes of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from tutor.exercise.nouns import GOAL_SERVICE, GOAL_TYPE, Action, Program, show
from tutor.exercise.seen_run import Seen, look, settle
from tutor.judge.bench import Bench, Run
from tutor.judge.peers import GoalClient
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import GoalAnswer
from tutor.judge.waiting_for_nodes import RESENT_S, patience_s, wait_until_seen

ANSWER_S = 5.0
"""Time limit for the answer to a goal, and to a request to cancel it."""

CANCELED_S = 3.0
"""Time limit for the end of a goal once the request to cancel it has been accepted."""

NEXT_S = 5.0
"""Time limit for the end of a goal that is sent after one that was rejected."""

OVERTAKEN_S = 0.7
"""Time after which feedback has arrived that the result has overtaken."""

Outcome = Literal["succeeded", "aborted", "canceled", "rejected"]
"""How a goal ends."""

Fields = Mapping[str, Any]
"""The fields of a goal, a feedback message or a result, with their values."""

Goal = Fields | Callable[[], Fields]
"""A goal, or a function that draws one at random, so that no result can be written down."""

OfGoal = Fields | Callable[[Fields], Fields]
"""Fields, or a function that makes them of the goal."""

STEPS: Mapping[str, str] = {
    "succeeded": "Call succeed() on the goal handle before the callback returns its result.",
    "aborted": "Call abort() on the goal handle before the callback returns its result.",
    "canceled": "Look at is_cancel_requested while the goal runs; then call canceled() on its handle, and return.",
    "rejected": "Give the action server a goal_callback that returns GoalResponse.REJECT for such a goal.",
}
"""The next step where a goal does not end so."""


@dataclass(frozen=True)
class GoalRun(Seen):
    """What became of a goal that we sent, and of one that was sent after it.

    `answer`: None if there was no action server. `next_answer`: None if no other goal was sent.
    """

    answer: GoalAnswer | None = None
    goal: Fields = field(default_factory=dict)
    next_answer: GoalAnswer | None = None


def drawn(goal: Goal) -> Fields:
    """The goal, drawn at random if it is a function."""
    return goal() if callable(goal) else goal


def of_goal(fields: OfGoal, goal: Fields) -> Fields:
    """The fields, made of the goal if they are a function."""
    return fields(goal) if callable(fields) else fields


def outcome_of(answer: GoalAnswer) -> str:
    """How a goal ended, "rejected" included; "" if it has not."""
    return "rejected" if answer.accepted is False else answer.outcome


def has_more(got: Fields, wanted: Fields) -> bool:
    """Whether a list has items that do not belong there."""
    lists = [(got.get(name), value) for name, value in wanted.items() if isinstance(value, list | tuple)]
    return any(isinstance(items, list | tuple) and any(item not in own for item in items) for items, own in lists)


def describe_goal(action: Action, goal: Fields) -> str:
    """A goal, for use in a sentence: "/count order=3"."""
    return " ".join([action.name, *(f"{name}={show(value)}" for name, value in goal.items())])


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


def is_over(client: GoalClient) -> bool:
    """Whether nothing more is to come of a goal but feedback that its result has overtaken."""
    return bool(client.seen.outcome) or client.seen.accepted is False


async def send(run: Run, client: GoalClient, goal: Fields) -> bool:
    """Send a goal, and return whether it is accepted."""
    client.send(goal)
    await run.until(lambda: client.seen.accepted is not None, ANSWER_S, idle_s=RESENT_S)
    return bool(client.seen.accepted)


async def pursue(
    run: Run,
    client: GoalClient,
    goal: Fields,
    cancel_after: int | None,
    limit_s: float,
    cancel_after_s: float = 0.0,
    not_canceled_s: float = math.inf,
) -> None:
    """Send a goal, and wait for how it ends.

    `cancel_after`: ask to cancel it after so many feedback messages, and not before `cancel_after_s` seconds.
    `not_canceled_s`: how long to wait for the end of a goal that is not canceled when we ask for it.
    """
    if not await send(run, client, goal):
        return
    if cancel_after is not None:
        await run.until(lambda: is_over(client) or len(client.seen.feedback) >= cancel_after, limit_s, idle_s=RESENT_S)
        await run.until(lambda: is_over(client), cancel_after_s)
        if not is_over(client):
            client.cancel()
            await run.until(
                lambda: is_over(client) or client.seen.cancel_accepted is not None, ANSWER_S, idle_s=RESENT_S
            )
            if client.seen.cancel_accepted is None:
                return
            limit_s = CANCELED_S if client.seen.cancel_accepted else min(limit_s, not_canceled_s)
    await run.until(lambda: is_over(client), limit_s, idle_s=RESENT_S)


@dataclass(frozen=True)
class SendGoal:
    """Start without parameters, and send a goal; see `pursue`.

    `feedback`: how many messages of it are waited for. `all_feedback`: wait also for those that the result may have
    overtaken. `next_goal`: another goal, which is sent once this one is over.
    """

    program: Program
    action: Action
    goal: Goal = field(hash=False)
    feedback: int
    cancel: bool
    within_s: float
    cancel_after_s: float = 0.0
    all_feedback: bool = False
    next_goal: Fields | None = field(default=None, hash=False)

    async def __call__(self, bench: Bench) -> GoalRun:
        action, goal = self.action, drawn(self.goal)
        async with (
            bench.start(self.program.file, expected_s=2.0) as run,
            run.goal_client(action.name, action.type) as client,
        ):
            bench.report_progress(0.1, f"waiting for the action server of {action.name}")
            if not await wait_for_server(run, action, client):
                return (await look(run, does_nothing=True)).having(GoalRun)
            bench.report_progress(0.4, f"sending a goal to {action.name}")
            cancel_after = self.feedback if self.cancel else None
            # A goal that was over cannot be canceled either, and its result may come a moment later.
            await pursue(run, client, goal, cancel_after, self.within_s, self.cancel_after_s, OVERTAKEN_S)
            # Feedback and result come on different ways: the last feedback may come after the result.
            await run.until(lambda: not self.all_feedback and len(client.seen.feedback) >= self.feedback, OVERTAKEN_S)
            answer = client.seen
            unheard = not answer.accepted or (self.cancel and answer.cancel_accepted is None and not answer.outcome)
            next_answer = await self._send_next(run) if is_over(client) else None
            unheard |= next_answer is not None and not outcome_of(next_answer)
            seen = await look(run, does_nothing=unheard)
            return seen.having(GoalRun, answer=answer, goal=goal, next_answer=next_answer)

    async def _send_next(self, run: Run) -> GoalAnswer | None:
        """Send the next goal, if there is one, and wait for how it ends."""
        if self.next_goal is None:
            return None
        async with run.goal_client(self.action.name, self.action.type) as client:
            if await wait_for_server(run, self.action, client):
                await pursue(run, client, self.next_goal, None, self.within_s or NEXT_S)
            return client.seen


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
