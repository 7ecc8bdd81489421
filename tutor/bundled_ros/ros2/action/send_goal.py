"""`ros2 action send_goal`."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from tutor.bundled_ros.ros2.arguments import yaml_or_stdin
from tutor.bundled_ros.ros2.calling import wait_for_answer, wait_until
from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.names import ACTIONS, class_of_type
from tutor.bundled_ros.ros2.parsing import Verb, argument, flag
from tutor.bundled_ros.ros2.yaml_input import message_from_yaml
from tutor.errors import CommandError
from tutor.ros.yaml_format import to_yaml

STATUS = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
"""The names of action_msgs/msg/GoalStatus, by number."""


def _send_goal(arguments: argparse.Namespace) -> None:
    """Send the goal and print its outcome; Ctrl+C cancels it. Raises CommandError."""
    from rclpy.action.client import ActionClient

    action_class = class_of_type(arguments.action_type, "action", "The passed action type is invalid")
    text = sys.stdin.read() if arguments.stdin else arguments.goal
    goal = message_from_yaml(action_class.Goal, text, failed="Failed to populate message fields: {!r}")
    with join_domain(arguments) as domain:
        client = ActionClient(domain.node, action_class, arguments.action_name)
        print("Waiting for an action server to become available...")
        wait_until(client.server_is_ready)
        print(f"Sending goal:\n     {to_yaml(goal)}")
        handle = wait_for_answer(domain, client.send_goal_async(goal, _print_feedback if arguments.feedback else None))
        try:
            _await_result(domain, handle)
        except KeyboardInterrupt:
            if handle.accepted:
                _cancel(domain, handle)
            raise


def _await_result(domain: Domain, handle: Any) -> None:
    if not handle.accepted:
        print("Goal was rejected.")
        return
    print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
    result = wait_for_answer(domain, handle.get_result_async())
    print(f"Result:\n    {to_yaml(result.result)}")
    print(f"Goal finished with status: {STATUS[result.status]}")


def _cancel(domain: Domain, handle: Any) -> None:
    print("Canceling goal...")
    if not wait_for_answer(domain, handle.cancel_goal_async()).goals_canceling:
        raise CommandError("Failed to cancel goal")
    print("Goal canceled.")


def _print_feedback(message: Any) -> None:
    print(f"Feedback:\n    {to_yaml(message.feedback)}")


GRAMMAR = {
    "send_goal": Verb(
        _send_goal,
        ACTIONS.argument(),
        argument("action_type", complete=ACTIONS.complete_types, help="its type"),
        yaml_or_stdin(
            "goal", "the goal as YAML, such as '{order: 10}'", stdin_help="read the goal from standard input"
        ),
        flag("-f", "--feedback", help="print the feedback as well"),
    )
}
