#!/usr/bin/env python3
"""Sends one goal to /countdown, shows how it goes, then ends."""

import sys

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

COUNT_FROM = 5
WAIT_S = 5.0
RESULT_WITHIN_S = 30.0


class CountdownClient(Node):
    """Asks for one countdown."""

    def __init__(self) -> None:
        super().__init__("countdown_client")
        self.client = ActionClient(self, Fibonacci, "countdown")

    def run(self) -> bool:
        """Send the goal and wait for its end. Return whether it succeeded."""
        log = self.get_logger()
        if not self.client.wait_for_server(timeout_sec=WAIT_S):
            log.error("There is no action /countdown: is countdown_server.py running?")
            return False
        # The first answer says only whether the goal is accepted...
        goal = Fibonacci.Goal(order=COUNT_FROM)
        sent = self.client.send_goal_async(goal, feedback_callback=self.show_feedback)
        rclpy.spin_until_future_complete(self, sent, timeout_sec=WAIT_S)
        if not sent.done():
            log.error(f"No answer to the goal within {WAIT_S} s")
            return False
        goal_handle = sent.result()
        if not goal_handle.accepted:
            log.error(f"The countdown from {COUNT_FROM} was rejected")
            return False
        # ... and the second one, which takes as long as the goal, says how it ended.
        ended = goal_handle.get_result_async()
        rclpy.spin_until_future_complete(self, ended, timeout_sec=RESULT_WITHIN_S)
        if not ended.done():
            log.error(f"No result within {RESULT_WITHIN_S} s: canceling the countdown")
            rclpy.spin_until_future_complete(self, goal_handle.cancel_goal_async(), timeout_sec=WAIT_S)
            return False
        log.info(f"Result: {list(ended.result().result.sequence)}")
        if ended.result().status != GoalStatus.STATUS_SUCCEEDED:
            log.error("The countdown did not get to its end")
            return False
        return True

    def show_feedback(self, message: Fibonacci.Impl.FeedbackMessage) -> None:
        """Log the newest number."""
        log = self.get_logger()
        log.info(f"Counting: {message.feedback.sequence[-1]}")


def main() -> None:
    """Run the client once: exit code 0 if the countdown succeeded, 1 if not."""
    rclpy.init()
    node = CountdownClient()
    done = False
    try:
        done = node.run()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C: not an error worth a traceback, but not done either.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    if not done:
        sys.exit(1)


if __name__ == "__main__":
    main()
