"""B1.4: verdicts on fabricated feedback of a countdown."""

from __future__ import annotations

import pytest

from checks.b1_4_countdown_action import CHECK
from tests.checks.builders import assert_passed, graph, judge_of, trace
from tutor.exercise.goal_run import GoalRun
from tutor.judge.trace import GoalAnswer, Sample

SERVED = trace(graph=graph(services={"/countdown/_action/send_goal": "example_interfaces/action/Fibonacci_SendGoal"}))


def counted(order: int, lengths: list[int]) -> GoalRun:
    """A countdown whose feedback messages hold so many numbers each."""
    whole = tuple(range(order, -1, -1))
    feedback = tuple(
        Sample("/countdown", {"sequence": whole[:length]}, 1000.0 + 0.25 * length, 1010.0) for length in lengths
    )
    answer = GoalAnswer(True, feedback, None, "succeeded", {"sequence": whole})
    return GoalRun(SERVED, answer=answer, goal={"order": order})


@pytest.mark.parametrize("order", [4, 5, 6])
def test_one_of_the_feedback_messages_may_be_missing(order: int) -> None:
    judge, lengths = judge_of(CHECK, "feedback"), list(range(1, order + 2))
    assert_passed(judge(counted(order, lengths)))
    assert_passed(judge(counted(order, [0, *lengths[:-1]])))
    for missing in lengths:
        assert_passed(judge(counted(order, [length for length in lengths if length != missing])))


@pytest.mark.parametrize("order", [4, 5, 6])
def test_feedback_after_every_second_number_is_not_enough(order: int) -> None:
    verdict = judge_of(CHECK, "feedback")(counted(order, list(range(1, order + 2, 2))))
    assert verdict is not None
    assert not verdict.passed
