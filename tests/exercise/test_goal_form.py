"""The form of an action's goal, judged on made-up facts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from tests.checks.builders import NO_NODE, assert_failed, assert_passed, graph, judge_of, trace
from tutor.exercise import Action, HandlesGoal, Program, check
from tutor.exercise.goal_run import GoalRun, Outcome
from tutor.judge.trace import GoalAnswer, Sample

COUNT = Action("/count", "example_interfaces/action/Fibonacci")
FEEDBACK = (Sample("/count", {"sequence": [0, 1]}, 1001.0, 1001.0),)
SERVED = trace(graph=graph(services={"/count/_action/send_goal": f"{COUNT.type}_SendGoal"}))
DONE = GoalAnswer(True, FEEDBACK, None, "succeeded", {"sequence": [0, 1, 1]})
CANCELED = GoalAnswer(True, FEEDBACK, True, "canceled", {"sequence": [0, 1]})
RUNNING = GoalAnswer(True, FEEDBACK)
REFUSED = GoalAnswer(accepted=False)


@pytest.mark.parametrize(
    ("ends", "answer", "cause", "words"),
    [
        ("succeeded", DONE, "", ""),
        ("canceled", CANCELED, "", ""),
        ("rejected", REFUSED, "", ""),
        ("aborted", replace(DONE, outcome="aborted"), "", ""),
        ("succeeded", replace(DONE, result={"sequence": [0, 2]}), "wrong goal", "[0, 2]"),
        ("succeeded", replace(DONE, feedback=()), "wrong goal", "0 feedback messages"),
        ("succeeded", replace(DONE, outcome="aborted"), "wrong goal", "it is aborted, not succeeded"),
        ("succeeded", REFUSED, "wrong goal", "GoalResponse.ACCEPT"),
        ("succeeded", RUNNING, "no answer", "does not end it within 10 s"),
        ("succeeded", GoalAnswer(), "no answer", "does not answer a goal"),
        ("rejected", RUNNING, "wrong goal", "it is accepted, not rejected"),
        ("rejected", DONE, "wrong goal", "it is accepted, not rejected"),
        ("rejected", GoalAnswer(), "no answer", "does not answer a goal"),
        ("canceled", DONE, "wrong goal", "it is succeeded, not canceled"),
        ("canceled", replace(RUNNING, cancel_accepted=False), "wrong goal", "cancel_callback"),
        ("canceled", replace(RUNNING, cancel_accepted=True), "wrong goal", "still runs 3 s after it accepted"),
        ("canceled", RUNNING, "wrong goal", "gets no answer"),
        ("canceled", REFUSED, "wrong goal", "it is rejected, not canceled"),
    ],
)
def test_a_goal_ends_as_it_should(ends: Outcome, answer: GoalAnswer, cause: str, words: str) -> None:
    wanted: dict[str, Any] = {} if ends == "rejected" else {"feedback": 1}
    if ends == "succeeded":
        wanted["result"] = {"sequence": [0, 1, 1]}
    made = check("t1", Program("node.py"), HandlesGoal("counts", COUNT, {"order": 2}, ends, **wanted))
    verdict = judge_of(made, "counts")(GoalRun(SERVED, answer=answer))
    if cause:
        assert_failed(verdict, cause, words, check=made)
    else:
        assert_passed(verdict)


@pytest.mark.parametrize(
    ("next_answer", "cause", "words"),
    [
        (replace(DONE, result={"sequence": [0]}), "", ""),
        (replace(DONE, result={"sequence": []}), "wrong goal", "ends with {'sequence': []}, not {'sequence': [0]}"),
        (replace(DONE, outcome="aborted"), "wrong goal", "is aborted, once another goal is"),
        (REFUSED, "wrong goal", "/count order=0 is rejected, once another goal is"),
        (RUNNING, "no answer", "does not end it"),
        (GoalAnswer(), "no answer", "does not answer a goal"),
        (None, "no answer", "does not answer a goal"),
    ],
)
@pytest.mark.parametrize(("ends", "answer"), [("rejected", REFUSED), ("canceled", CANCELED)])
def test_a_goal_that_is_sent_then_must_succeed(
    ends: Outcome, answer: GoalAnswer, next_answer: GoalAnswer | None, cause: str, words: str
) -> None:
    counted = {"sequence": [0]}
    form = HandlesGoal("counts", COUNT, {"order": 2}, ends, result=lambda goal: counted, then={"order": 0})
    if ends == "canceled":
        answer = replace(answer, result=counted)
    made = check("t1", Program("node.py"), form)
    verdict = judge_of(made, "counts")(GoalRun(SERVED, answer=answer, next_answer=next_answer))
    if cause:
        assert_failed(verdict, cause, words, check=made)
    else:
        assert_passed(verdict)
        assert "then /count order=0 succeeds" in verdict.observed


@pytest.mark.parametrize(
    ("got", "cause"),
    [([2, 1, 0], "shared state"), ([0, 1], "shared state"), ([7, 0], "wrong goal"), ([], "wrong goal")],
)
def test_only_what_belongs_to_the_goal_before_is_shared(got: list[int], cause: str) -> None:
    def counted(goal: Mapping[str, Any]) -> Mapping[str, Any]:
        return {"sequence": list(range(goal["order"], -1, -1))}

    form = HandlesGoal("stops", COUNT, {"order": 5}, "canceled", result=counted, partial=True, then={"order": 0})
    made = check("t1", Program("node.py"), form)
    before = replace(CANCELED, result={"sequence": [5, 4]})
    found = GoalRun(SERVED, answer=before, goal={"order": 5}, next_answer=replace(DONE, result={"sequence": got}))
    assert_failed(judge_of(made, "stops")(found), cause, check=made)


def test_a_missing_server_is_told_with_those_that_are_there() -> None:
    made = check("t1", Program("node.py"), HandlesGoal("counts", COUNT, {"order": 2}))
    judge = judge_of(made, "counts")
    other = trace(graph=graph(services={"/counter/_action/send_goal": f"{COUNT.type}_SendGoal"}))
    assert_failed(judge(GoalRun(other)), "action missing", f"/counter of type {COUNT.type}", check=made)
    assert_failed(judge(GoalRun(trace())), "action missing", "has no action server /count", check=made)
    assert_failed(judge(GoalRun(NO_NODE)), "no node", check=made)


def test_an_unknown_end_or_type_is_the_authors_mistake() -> None:
    with pytest.raises(ValueError, match="'won' is no end of a goal: take one of succeeded, aborted, canceled"):
        HandlesGoal("counts", COUNT, {}, "won")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="is no type such as package/action/Name"):
        Action("/count", "std_msgs/msg/String")
