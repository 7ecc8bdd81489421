"""B1.4 An Action: a server that counts down, step by step, until it is done, canceled or replaced; and its client."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import Any

from tutor.exercise import (
    Action,
    DuringGoal,
    EndsCleanly,
    GoalReplies,
    HandlesGoal,
    HandlesRejection,
    HandlesTwoGoals,
    Program,
    SendsFeedback,
    SendsGoal,
    check,
)

SERVER, CLIENT = Program("countdown_server.py"), Program("countdown_client.py")
COUNTDOWN = Action("/countdown", "example_interfaces/action/Fibonacci")
LONG = {"order": 300}
"""It takes more than a minute: none that we send gets to its end."""


def short() -> Mapping[str, Any]:
    """A goal of a second or so."""
    return {"order": random.randint(4, 6)}


def counted(goal: Mapping[str, Any]) -> Mapping[str, Any]:
    """The right result."""
    return {"sequence": list(range(goal["order"], -1, -1))}


def steps(goal: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """The right feedback, in its order."""
    whole = counted(goal)["sequence"]
    return [{"sequence": whole[:length]} for length in range(len(whole) + 1)]


def replies() -> GoalReplies:
    """Numbers that a client cannot know, so that it has to show what it gets.

    Each message has others, and one more than the message before: a client may show only what is new at the end.
    """
    *feedback, result = (
        random.sample(range(thousand, thousand + 1000), length)
        for length, thousand in enumerate(range(10_000, 15_000, 1000), 1)
    )
    return GoalReplies(True, tuple({"sequence": numbers} for numbers in feedback), {"sequence": result})


goal = HandlesGoal("goal", COUNTDOWN, short, result=counted)
client = SendsGoal("client", CLIENT, COUNTDOWN, replies, shows=lambda message: message["sequence"][-1])

CHECK = check(
    "b1.4",
    SERVER,
    goal,
    SendsFeedback("feedback", goal, steps, may_miss=2, over_s=0.3, after=goal),
    HandlesGoal(
        "cancel",
        COUNTDOWN,
        LONG,
        "canceled",
        result=counted,
        partial=True,
        cancel_after_s=1.0,
        then={"order": 2},
        after=goal,
    ),
    HandlesTwoGoals("replace", COUNTDOWN, (LONG, short), ("aborted", "succeeded"), result=counted, after=goal),
    HandlesGoal("reject", COUNTDOWN, {"order": -1}, "rejected", result=counted, then={"order": 0}, after=goal),
    client,
    HandlesRejection("client-rejected", client, after=client),
    EndsCleanly("shutdown", bonus=True),
    EndsCleanly("shutdown-busy", DuringGoal(SERVER, COUNTDOWN, LONG), goal, after=goal, bonus=True),
    expected_s=3.0,
    expected_reason="a countdown from 6: a second and a half; a client that waits for our server",
)
