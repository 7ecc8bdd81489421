"""What each symptom of actions says where no mistake of the catalogue explains it."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


@symptom("action-missing", explains=[Symptom.ACTION_MISSING])
def action_missing(case: Case) -> Iterator[Found]:
    """A node has no such action server.

    An action server is there once an ActionServer has been made with the node, its type and its name, and the callback
    that executes a goal. It lives as long as something keeps it.

    Bad:

        ActionServer(self, Fibonacci, 'count', self.count)

    Good:

        self.server = ActionServer(self, Fibonacci, 'count', self.count)

    See it: `ros2 action list -t`.
    """
    action = case.about("action", "such action")
    return in_words(
        case,
        f"{case.nodes} is up, but has no action server {action}",
        "Make the action server where the node is set up, under exactly this name and with this type.",
    )


@symptom("wrong-goal", explains=[Symptom.WRONG_GOAL])
def wrong_goal(case: Case) -> Iterator[Found]:
    """An action server handles a goal, but not as it should.

    How a goal ends is what the callback calls on its handle before it returns: succeed(), abort() or canceled().
    Without any, it counts as aborted. The result is what the callback returns. A goal can be canceled only if a
    cancel_callback accepts that, and if the callback looks at is_cancel_requested.

    Bad:

        def count(self, goal_handle):
            return Fibonacci.Result(sequence=[0, 1])

    Good:

        def count(self, goal_handle):
            goal_handle.succeed()
            return Fibonacci.Result(sequence=[0, 1])

    See it: `ros2 action send_goal --feedback ACTION TYPE VALUES`.
    """
    action = case.about("action", "the action")
    return in_words(
        case,
        f"a goal of {action} does not go as it should",
        "Send the goal by hand, and follow it through the callback that executes it.",
    )


@symptom("goal-not-followed", explains=[Symptom.NOT_TOLD])
def goal_not_followed(case: Case) -> Iterator[Found]:
    """A client sends a goal, and does not say what becomes of it.

    Three things come back from an action server: whether it accepts the goal, feedback, and the result. Each has to be
    asked for, and waited for: a goal handle is not the result, and what nobody gives a callback for is dropped.

    Bad:

        sent = self.gate.send_goal_async(Gate.Goal(speed=3))
        rclpy.spin_until_future_complete(self, sent)
        print(sent.result())

    Good:

        sent = self.gate.send_goal_async(Gate.Goal(speed=3), feedback_callback=self.show_angle)
        rclpy.spin_until_future_complete(self, sent)
        ended = sent.result().get_result_async()
        rclpy.spin_until_future_complete(self, ended)
        print(ended.result().result)

    See it: compare with what `ros2 action send_goal --feedback ACTION TYPE VALUES` shows.
    """
    return in_words(
        case,
        "the client does not say what becomes of its goal",
        "Follow the goal in the client: is it accepted, what does feedback say, and what is the result?",
    )
