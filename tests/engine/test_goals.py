"""Goals of actions, by a form and by a function, on real action servers."""

from __future__ import annotations

import pytest

from tests.engine.helpers import NODE, Scene, assert_failed_for, statuses
from tutor.exercise import Action, HandlesGoal, HandlesTwoGoals, Node, Program, SendsFeedback, check, criterion

COUNT = Action("/count", "example_interfaces/action/Fibonacci")


@criterion("short", "a goal of order 2 gives 0, 1, 1, and one that is canceled ends")
async def short(node: Node) -> None:
    ended = await node.send_goal(COUNT, order=2)
    node.expect(ended.outcome, "succeeded", do="Let the goal succeed.")
    node.expect(ended.result.sequence, [0, 1, 1], do="Put the numbers into the result.")
    node.expect((await node.send_goal(COUNT, cancel_after=1, order=40)).outcome, "canceled", do="Let it be canceled.")


NUMBERS = [0, 1, 1, 2, 3, 5]

counts = HandlesGoal("counts", COUNT, {"order": 5}, feedback=4, result={"sequence": NUMBERS})

CHECK = check(
    "t1",
    Program("node.py"),
    counts,
    SendsFeedback("tells", counts, [{"sequence": NUMBERS[:length]} for length in range(3, 7)], may_miss=1, over_s=0.1),
    HandlesTwoGoals("both", COUNT, ({"order": 40}, {"order": 5}), ("succeeded", "succeeded")),
    HandlesGoal("stops", COUNT, {"order": 40}, ends="canceled", feedback=2),
    HandlesGoal("refuses", COUNT, {"order": -1}, ends="rejected"),
    HandlesGoal("gives-up", COUNT, {"order": 100}, ends="aborted", within_s=3.0),
    short,
)

SERVER = """
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor

class Server:
    name = "count"
    first = 0
    step_s = 0.05
    answer = CancelResponse.ACCEPT
    feedback = 1

    def __init__(self):
        self.server = ActionServer(
            node, Fibonacci, self.name, self.count, goal_callback=self.accept,
            cancel_callback=lambda handle: self.answer, callback_group=ReentrantCallbackGroup(),
        )

    def accept(self, goal):
        return GoalResponse.ACCEPT if goal.order >= 0 else GoalResponse.REJECT

    def count(self, handle):
        numbers = [self.first, 1]
        if handle.request.order > 50:
            handle.abort()
            return Fibonacci.Result()
        while len(numbers) <= handle.request.order:
            if handle.is_cancel_requested:
                handle.canceled()
                return Fibonacci.Result(sequence=numbers)
            time.sleep(self.step_s)
            numbers.append(numbers[-1] + numbers[-2])
            if self.feedback:
                handle.publish_feedback(Fibonacci.Feedback(sequence=numbers))
        self.succeed(handle)
        return Fibonacci.Result(sequence=numbers)

    def succeed(self, handle):
        handle.succeed()

def spin(node):
    executor = MultiThreadedExecutor(4)
    executor.add_node(node)
    executor.spin()
rclpy.spin = spin
"""


def server(change: str = "pass") -> str:
    """A learner's node: the action server, with a change of the class before it is made."""
    return NODE.format(f"{SERVER}\n{change}\nserver = Server()")


async def test_a_right_server_passes(scene: Scene) -> None:
    result = await scene.judge(*CHECK.criteria, source=server())
    assert set(statuses(result).values()) == {"passed"}, result


async def test_a_server_that_sends_its_feedback_at_once_passes(scene: Scene) -> None:
    only = frozenset({"counts"})
    result = await scene.judge(*CHECK.criteria, source=server("Server.step_s = 0.0"), only=only)
    assert statuses(result) == {"counts": "passed"}, result


@pytest.mark.parametrize(
    ("change", "criterion", "mistake", "words"),
    [
        ("Server.name = 'counter'", "counts", "action-missing", "/counter of type"),
        ("Server.succeed = lambda self, handle: None", "counts", "goal-without-an-end", "it is aborted, not succeeded"),
        ("Server.first = 1", "counts", "wrong-goal", "[1, 1, 2, 3, 5, 8]"),
        ("Server.feedback = 0", "counts", "wrong-goal", "0 feedback messages"),
        ("Server.accept = lambda self, goal: GoalResponse.REJECT", "counts", "wrong-goal", "it is rejected"),
        ("Server.accept = lambda self, goal: GoalResponse.ACCEPT", "refuses", "wrong-goal", "it is accepted"),
        ("Server.succeed = lambda self, handle: threading.Event().wait()", "counts", "no-answer", "does not end it"),
        ("Server.answer = CancelResponse.REJECT", "stops", "cancel-not-accepted", "request to cancel it is not"),
        ("Server.count = lambda self, handle: 1 / 0", "counts", "unhandled-exception", "division by zero"),
        ("Server.count = lambda self, handle: handle.succeed() or Fibonacci.Result()", "stops", "wrong-goal", "succ"),
        (
            "Server.count = lambda self, handle: handle.succeed() or Fibonacci.Result()",
            "gives-up",
            "wrong-goal",
            "succ",
        ),
        ("Server.feedback = 0", "tells", "wrong-goal", "0 feedback messages"),
        ("Server.step_s = 0.0", "tells", "wrong-goal", "all feedback within 0.0"),
        ("Server.step_s = 0.5", "both", "wrong-goal", "the first goal still runs after 6 s"),
        ("Server.first = 1", "short", "wrong-goal", "[1, 1, 2]"),
        ("Server.name = 'counter'", "short", "action-missing", "no action server"),
    ],
)
async def test_a_wrong_server_fails_what_it_breaks(
    scene: Scene, change: str, criterion: str, mistake: str, words: str
) -> None:
    result = await scene.judge(*CHECK.criteria, source=server(change), only=frozenset({criterion}))
    assert_failed_for(result, mistake, words)
