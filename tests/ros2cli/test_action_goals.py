"""ros2 action send_goal, with the action type that the bundled ROS has."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tests.ros2cli.bench import Bench, Ran

TYPE = "example_interfaces/action/Fibonacci"

SERVER = """
import time
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor

node = rclpy.create_node("fibonacci_server")

def count(goal):
    sequence = [0, 1]
    if goal.request.order > 40:  # until it is cancelled
        goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        while not goal.is_cancel_requested:
            time.sleep(0.01)
        goal.canceled()
        return Fibonacci.Result()
    while len(sequence) <= goal.request.order:
        sequence.append(sequence[-1] + sequence[-2])
        goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
    goal.succeed()
    return Fibonacci.Result(sequence=sequence)

server = ActionServer(
    node, Fibonacci, "fibonacci", count,
    callback_group=ReentrantCallbackGroup(),
    goal_callback=lambda goal: GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT,
    cancel_callback=lambda _: CancelResponse.ACCEPT,
)
executor = MultiThreadedExecutor(3)
executor.add_node(node)
print("ready", flush=True)
try:
    executor.spin()
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""

SENDING = "Waiting for an action server to become available...\nSending goal:\n     order: {}\n\n"


@pytest.fixture(scope="module")
def action(module_bench: Bench) -> Iterator[Bench]:
    """A bench with a server of /fibonacci."""
    with module_bench.node(SERVER):
        yield module_bench


def without_ids(text: str) -> str:
    return re.sub(r"ID: [0-9a-f]{32}\n", "ID: ID\n", text)


def test_a_goal_is_sent_and_its_result_shown(action: Bench) -> None:
    ran = action.ros2("action", "send_goal", "/fibonacci", TYPE, "{order: 5}")
    numbers = "".join(f"- {number}\n" for number in (0, 1, 1, 2, 3, 5))
    result = f"Goal accepted with ID: ID\n\nResult:\n    sequence:\n{numbers}\nGoal finished with status: SUCCEEDED\n"
    assert Ran(without_ids(ran.stdout), ran.stderr, ran.code) == Ran(SENDING.format(5) + result, "", 0)
    by_stdin = action.ros2("action", "send_goal", "--stdin", "fibonacci", TYPE, stdin="{order: 5}")
    assert without_ids(by_stdin.stdout) == without_ids(ran.stdout)
    assert action.ros2("action", "list", "-t").stdout == f"/fibonacci [{TYPE}]\n"
    assert action.ros2("action", "type", "/fibonacci").stdout == f"{TYPE}\n"


def test_feedback_is_shown_when_asked_for(action: Bench) -> None:
    ran = action.ros2("action", "send_goal", "-f", "/fibonacci", TYPE, "{order: 3}")
    assert "Feedback:\n    sequence:\n- 0\n- 1\n- 1\n\n" in ran.stdout
    assert ran.stdout.endswith("- 2\n\nGoal finished with status: SUCCEEDED\n")
    assert (ran.stderr, ran.code) == ("", 0)


def test_a_goal_can_be_rejected_or_wrong(action: Bench) -> None:
    rejected = action.ros2("action", "send_goal", "/fibonacci", TYPE, "{order: -1}")
    assert rejected == Ran(SENDING.format(-1) + "Goal was rejected.\n", "", 0)
    wrong = action.ros2("action", "send_goal", "/fibonacci", TYPE, "{oder: 5}")
    assert (wrong.stdout, wrong.code) == ("", 1)
    assert wrong.stderr.startswith("Failed to populate message fields: AttributeError(")


def test_ctrl_c_cancels_the_goal(action: Bench) -> None:
    with action.running("action", "send_goal", "/fibonacci", TYPE, "{order: 99}") as running:
        while not running.line().startswith("Goal accepted"):
            pass
        ran = running.interrupt()
    assert ran.stdout.endswith("Canceling goal...\nGoal canceled.\n")
    assert (ran.stderr, ran.code) == ("", 2)
