"""Clients of actions against our action server, and a server that is ended while a goal runs."""

from __future__ import annotations

import pytest

from tests.engine.helpers import Scene, assert_failed_for, statuses
from tests.engine.test_goals import server
from tutor.exercise import (
    Action,
    DuringGoal,
    EndsCleanly,
    GoalReplies,
    HandlesGoal,
    HandlesRejection,
    Program,
    SendsGoal,
    check,
)

COUNT = Action("/count", "example_interfaces/action/Fibonacci")
REPLIES = GoalReplies(True, tuple({"sequence": [n]} for n in (31231, 31232, 31233)), {"sequence": [31234]}, step_s=0.2)

sends = SendsGoal("sends", Program("node.py"), COUNT, lambda: REPLIES, shows=lambda message: message["sequence"][0])
CLIENT = check("t1", Program("node.py"), sends, HandlesRejection("rejected", sends, after=sends))

SOURCE = """
import rclpy
from rclpy.action import ActionClient
from example_interfaces.action import Fibonacci

rclpy.init()
node = rclpy.create_node("learner")
client = ActionClient(node, Fibonacci, "count")
client.wait_for_server()
sent = client.send_goal_async(Fibonacci.Goal(order=3), lambda message: print(message.feedback))
rclpy.spin_until_future_complete(node, sent)
if {accepted}:
    ended = sent.result().get_result_async()
    rclpy.spin_until_future_complete(node, ended)
    print("result", ended.result().result)
else:
    print("rejected")
{then}
rclpy.shutdown()
"""


def client(accepted: str = "sent.result().accepted", then: str = "") -> str:
    return SOURCE.format(accepted=accepted, then=then)


async def test_a_right_client_passes(scene: Scene) -> None:
    result = await scene.judge(*CLIENT.criteria, source=client())
    assert set(statuses(result).values()) == {"passed"}, result


@pytest.mark.parametrize(
    ("source", "criterion", "mistake", "words"),
    [
        (client("False"), "sends", "goal-not-followed", "the result 31234 is not shown"),
        (client("True"), "rejected", "acceptance-not-looked-at", "nothing that it says is about that"),
        (client(then="rclpy.spin(node)"), "sends", "spin-never-returns", "still runs"),
        (client().replace('"count"', '"counter"'), "sends", "calls-missing", "for /counter, not for /count"),
    ],
    ids=["no result", "accepted is not looked at", "spins on", "another action"],
)
async def test_a_wrong_client_fails(scene: Scene, source: str, criterion: str, mistake: str, words: str) -> None:
    result = await scene.judge(*CLIENT.criteria, source=source, only=frozenset({criterion}))
    assert_failed_for(result, mistake, words)


BUSY = check(
    "t1",
    Program("node.py"),
    goes := HandlesGoal("goes", COUNT, {"order": 2}),
    EndsCleanly("ends", DuringGoal(Program("node.py"), COUNT, {"order": 50}), goes),
)


async def test_a_server_whose_goal_sleeps_on_does_not_end_cleanly(scene: Scene) -> None:
    result = await scene.judge(*BUSY.criteria, source=server("Server.step_s = 0.3"), only=frozenset({"ends"}))
    assert statuses(result) == {"ends": "failed"}, result
