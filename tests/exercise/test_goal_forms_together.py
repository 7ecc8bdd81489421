"""The forms of feedback and of a second goal, judged on made-up facts."""

from __future__ import annotations

from typing import Any

import pytest

from tests.checks.builders import assert_failed, assert_passed, graph, judge_of, trace
from tutor.exercise import Action, HandlesGoal, HandlesTwoGoals, Program, SendsFeedback, check
from tutor.exercise.goal_run import GoalRun, SendGoal
from tutor.exercise.handles_two_goals import TwoGoals
from tutor.judge.trace import GoalAnswer, Sample

COUNT = Action("/count", "example_interfaces/action/Fibonacci")
SERVED = trace(graph=graph(services={"/count/_action/send_goal": f"{COUNT.type}_SendGoal"}))
GOAL = {"order": 3}
WHOLE = [3, 2, 1, 0]


def steps(goal: Any) -> list[dict[str, Any]]:
    return [{"sequence": list(range(goal["order"], goal["order"] - length, -1))} for length in range(1, 5)]


GOES = HandlesGoal("goes", COUNT, GOAL, result={"sequence": WHOLE})
FED = check("t1", Program("node.py"), GOES, SendsFeedback("tells", GOES, steps, may_miss=1, over_s=0.3, after=GOES))
TWO = check(
    "t2", Program("node.py"), HandlesTwoGoals("newer", COUNT, ({"order": 40}, GOAL), result={"sequence": WHOLE})
)


def fed(*messages: list[int], gap_s: float = 0.25, outcome: str = "succeeded") -> GoalRun:
    """A goal that got these feedback messages."""
    feedback = tuple(
        Sample("/count", {"sequence": message}, 1000.0 + gap_s * number, 1010.0)
        for number, message in enumerate(messages)
    )
    return GoalRun(SERVED, answer=GoalAnswer(True, feedback, None, outcome, {"sequence": WHOLE}), goal=GOAL)


@pytest.mark.parametrize(
    "messages",
    [
        ([3], [3, 2], [3, 2, 1], [3, 2, 1, 0]),
        ([3], [3, 2], [3, 2, 1]),
        ([3, 2], [3, 2, 1], [3, 2, 1, 0]),
        ([3], [3], [3, 2], [3, 2, 1], [3, 2, 1, 0]),
    ],
    ids=["all", "without the last", "without the first", "one twice"],
)
def test_feedback_may_lack_a_step_and_say_one_twice(messages: tuple[list[int], ...]) -> None:
    assert_passed(judge_of(FED, "tells")(fed(*messages)))


def test_feedback_counts_however_the_goal_ended() -> None:
    assert_passed(judge_of(FED, "tells")(fed([3], [3, 2], [3, 2, 1], outcome="aborted")))


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (fed(), "0 feedback messages"),
        (fed([3, 2, 1, 0]), "1 feedback message"),
        (fed([3, 2, 1], [3, 2, 1], [3, 2, 1]), "1 feedback message"),
        (fed([3], [2], [1], [0]), "feedback {'sequence': [2]}"),
        (fed([3, 2], [3], [3, 2, 1]), "feedback {'sequence': [3]}"),
        (fed([3], [3, 2], [3, 2, 1], [3, 2, 1, 0], gap_s=0.001), "within 0.00 s"),
    ],
    ids=["none", "once", "the same", "only the newest", "backwards", "all at once"],
)
def test_feedback_that_is_missing_wrong_or_late_is_told(found: GoalRun, words: str) -> None:
    assert_failed(judge_of(FED, "tells")(found), "wrong goal", words, check=FED)


def test_one_run_is_judged_by_both_criteria() -> None:
    goes, tells = FED.criteria
    assert goes.facts == tells.facts
    assert isinstance(goes.facts[0], SendGoal)


def test_a_random_goal_is_judged_by_the_one_that_was_sent() -> None:
    drawn = HandlesGoal("goes", COUNT, lambda: {"order": 5}, result=lambda goal: {"sequence": steps(goal)[-1]})
    made = check("t1", Program("node.py"), drawn)
    answer = GoalAnswer(True, (), None, "succeeded", {"sequence": {"sequence": [3, 2, 1, 0]}})
    assert_passed(judge_of(made, "goes")(GoalRun(SERVED, answer=answer, goal=GOAL)))


@pytest.mark.parametrize(("got", "passes"), [([3, 2], True), (WHOLE, False), ([], False), ([3, 1], False)])
def test_a_partial_result_has_begun_and_is_not_complete(got: list[int], *, passes: bool) -> None:
    form = HandlesGoal("stops", COUNT, GOAL, "canceled", result={"sequence": WHOLE}, partial=True)
    made = check("t1", Program("node.py"), form)
    answer = GoalAnswer(True, (), True, "canceled", {"sequence": got})
    verdict = judge_of(made, "stops")(GoalRun(SERVED, answer=answer, goal=GOAL))
    if passes:
        assert_passed(verdict)
    else:
        assert_failed(verdict, "wrong goal", "not {'sequence': [3, 2, 1, 0]}", check=made)


def two(first: GoalAnswer, second: GoalAnswer) -> TwoGoals:
    return TwoGoals(SERVED, of_goals=(first, second), goals=({"order": 40}, GOAL))


ABORTED = GoalAnswer(True, (), None, "aborted", {"sequence": [40]})
RUNNING = GoalAnswer(True)
DONE = GoalAnswer(True, (), None, "succeeded", {"sequence": WHOLE})


def test_a_new_goal_replaces_the_old_one() -> None:
    assert_passed(judge_of(TWO, "newer")(two(ABORTED, DONE)))


@pytest.mark.parametrize(
    ("found", "cause", "words"),
    [
        (TwoGoals(trace()), "action missing", "has no action server"),
        (two(RUNNING, DONE), "wrong goal", "the first goal still runs after 3 s, instead of being aborted"),
        (two(DONE, DONE), "wrong goal", "the first goal is succeeded, instead of being aborted"),
        (two(RUNNING, GoalAnswer()), "wrong goal", "the second goal gets no answer while the first one runs"),
        (two(GoalAnswer(False), GoalAnswer()), "wrong goal", "the first goal is rejected, instead of being aborted"),
        (two(ABORTED, GoalAnswer(False)), "wrong goal", "the second goal is rejected, instead of being succeeded"),
        (two(ABORTED, GoalAnswer(True, (), None, "succeeded", {"sequence": []})), "wrong goal", "ends with"),
        (two(ABORTED, GoalAnswer(True, (), None, "succeeded", {"sequence": [40, *WHOLE]})), "shared state", "belongs"),
    ],
)
def test_two_goals_that_do_not_end_as_they_should(found: TwoGoals, cause: str, words: str) -> None:
    assert_failed(judge_of(TWO, "newer")(found), cause, words, check=TWO)


def test_a_server_that_is_busy_may_be_asked_for() -> None:
    goals = ({"order": 40}, GOAL)
    made = check("t1", Program("node.py"), HandlesTwoGoals("busy", COUNT, goals, ("succeeded", "rejected")))
    assert_passed(judge_of(made, "busy")(two(DONE, GoalAnswer(False))))
