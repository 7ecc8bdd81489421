"""The forms of an action client, judged on made-up facts."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from tests.checks.builders import CRASH, assert_failed, assert_passed, exited, judge_of, log, trace
from tutor.exercise import Action, GoalReplies, HandlesRejection, Program, SendsGoal, check
from tutor.exercise.goal_client_run import GoalClientRun
from tutor.judge.trace import Exit, ServedGoal
from tutor.judge.tracebacks import Frame
from tutor.ros_model import ServiceEndpoint

COUNT = Action("/count", "example_interfaces/action/Fibonacci")
REPLIES = GoalReplies(True, ({"sequence": [11111]}, {"sequence": [11111, 22222]}), {"sequence": [11111, 22222, 33333]})
SENDS = SendsGoal("client", Program("node.py"), COUNT, lambda: REPLIES, shows=lambda message: message["sequence"][-1])
CHECK = check("t1", Program("server.py"), SENDS, HandlesRejection("rejected", SENDS, after=SENDS))
SAID = ("sending 5", "feedback: [11111]", "feedback: [11111, 22222]", "result: array('i', [11111, 22222, 33333])")


def ran(*said: str, code: int | None = 0, goals: int = 1, ended: bool = True, **more: Any) -> GoalClientRun:
    """A run of a client that logged this, and got all that there was."""
    served = (ServedGoal({"order": 5}, True, 0.0, 2, ended),) * goals
    seen = trace(logs=tuple(map(log, said)), exit=exited(code) if code is not None else None)
    return GoalClientRun(seen, REPLIES, served, seen.exit, **more)


def refused(*said: str, code: int | None = 0, err: str = "", **more: Any) -> GoalClientRun:
    """A run of a client whose goal was rejected."""
    seen = trace(logs=tuple(map(log, said)), exit=exited(code) if code is not None else None, err=err)
    return GoalClientRun(seen, GoalReplies(accepts=False), (ServedGoal({"order": 5}, False),), seen.exit, **more)


def test_a_client_shows_feedback_and_result_and_ends() -> None:
    assert_passed(judge_of(CHECK, "client")(ran(*SAID)))


def test_feedback_that_the_result_has_overtaken_need_not_be_shown() -> None:
    assert_passed(judge_of(CHECK, "client")(ran("feedback: [11111]", "result: 33333")))


def test_what_is_printed_counts_as_well() -> None:
    printed = replace(ran(), trace=trace(out="\n".join(SAID), exit=exited(0)))
    assert_passed(judge_of(CHECK, "client")(printed))


@pytest.mark.parametrize("mark", ["...", "T-", "=", "0, ", "000"])
def test_what_stands_before_a_number_does_not_matter(mark: str) -> None:
    assert_passed(judge_of(CHECK, "client")(ran(f"{mark}11111", f"{mark}22222", f"{mark}33333")))


def test_thousands_may_be_apart() -> None:
    assert_passed(judge_of(CHECK, "client")(ran("11,111", "[11,111, 22,222]", "[11111,22222,33333]")))
    assert_passed(judge_of(CHECK, "client")(ran("11_111", "22_222", "33'333")))


@pytest.mark.parametrize("shown", ["0.33333", "333330", "133333", "33333.5"])
def test_a_part_of_a_number_is_not_the_number(shown: str) -> None:
    verdict = judge_of(CHECK, "client")(ran(*SAID[:3], shown))
    assert_failed(verdict, "goal not followed", "the result 33333 is not shown", check=CHECK)


SPINS = (Frame("/lib/rclpy/executors.py", 1, "spin", "", 1), Frame("/home/me/ws/node.py", 9, "main", "spin(node)", 1))


@pytest.mark.parametrize(
    ("seen", "cause", "words"),
    [
        (GoalClientRun(None), "file missing", "there is no node.py"),
        (ran("hello", goals=0), "calls missing", "sent no goal"),
        (ran(*SAID, code=1), "non-zero exit", "exit code 1"),
        (ran(*SAID[:3]), "goal not followed", "the result 33333 is not shown"),
        (ran(*SAID[:3], "result: [5, 4, 3, 2, 1, 0]"), "goal not followed", "the result 33333 is not shown"),
        (ran(*SAID[:2], ended=False), "goal not followed", "before there was one"),
        (ran(SAID[0], "the last is 33333"), "goal not followed", "it shows 0"),
        (ran(*SAID, code=None, stuck=SPINS), "spin never returns", "its goal has its result"),
    ],
    ids=["no file", "no goal", "exit code", "no result", "made up", "too early", "no feedback", "goes on"],
)
def test_a_client_that_does_not_do_all_is_told_what_is_missing(seen: GoalClientRun, cause: str, words: str) -> None:
    assert_failed(judge_of(CHECK, "client")(seen), cause, words, check=CHECK)


def test_a_client_of_another_action_is_told_so() -> None:
    clients = (ServiceEndpoint("/counter/_action/send_goal", f"{COUNT.type}_SendGoal", "/node"),)
    verdict = judge_of(CHECK, "client")(ran(goals=0, clients=clients))
    assert_failed(verdict, "calls missing", "its action client is for /counter, not for /count", check=CHECK)


@pytest.mark.parametrize("said", ["the goal was rejected", "abgelehnt", "Goal accepted: False"])
def test_a_rejection_is_told_in_any_words(said: str) -> None:
    assert_passed(judge_of(CHECK, "rejected")(refused(SAID[0], said, code=1), ran(*SAID)))


def test_a_client_that_aborts_has_no_traceback() -> None:
    aborted = replace(refused(SAID[0], "the goal was rejected"), exit=Exit(None, 6, 1.5))
    verdict = judge_of(CHECK, "rejected")(aborted, ran(*SAID))
    assert verdict is not None
    assert not verdict.passed
    assert "signal 6" in verdict.observed
    assert "traceback" not in verdict.observed


@pytest.mark.parametrize(
    ("seen", "words"),
    [
        (refused(SAID[0]), "nothing that it says is about that"),
        (refused(SAID[0], "result: array('i')"), "nothing that it says is about that"),
        (refused(SAID[0], code=None), "its goal was rejected"),
        (refused(err=CRASH, code=1), "traceback"),
    ],
    ids=["no word", "an empty result", "goes on", "a traceback"],
)
def test_a_rejection_that_is_not_told_or_not_survived_fails(seen: GoalClientRun, words: str) -> None:
    verdict = judge_of(CHECK, "rejected")(seen, ran(*SAID))
    assert verdict is not None
    assert not verdict.passed
    assert words in str(verdict)
