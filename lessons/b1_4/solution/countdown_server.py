#!/usr/bin/env python3
"""Counts down to zero, step by step, for whoever sends a goal to /countdown."""

import threading

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

STEP_S = 0.25
THREADS = 4


class CountdownServer(Node):
    """Runs one countdown at a time: a new goal replaces the one that is running."""

    def __init__(self) -> None:
        super().__init__("countdown_server")
        self.newest: ServerGoalHandle | None = None
        self.stopping = threading.Event()
        self.server = ActionServer(
            self,
            Fibonacci,
            "countdown",
            execute_callback=self.count_down,
            goal_callback=self.decide,
            handle_accepted_callback=self.replace,
            cancel_callback=self.agree_to_cancel,
        )
        self.get_logger().info("Send a goal to /countdown")

    def decide(self, goal: Fibonacci.Goal) -> GoalResponse:
        """Reject a countdown that would never get to zero."""
        if goal.order < 0:
            self.get_logger().warning(f"Rejected: cannot count down from {goal.order}")
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def agree_to_cancel(self, goal_handle: ServerGoalHandle) -> CancelResponse:
        """Let every goal be canceled. This only allows it: count_down() does it."""
        return CancelResponse.ACCEPT

    def replace(self, goal_handle: ServerGoalHandle) -> None:
        """Make this goal the newest one, and start it. The previous one sees that it is no longer the newest."""
        self.newest = goal_handle
        goal_handle.execute()

    def count_down(self, goal_handle: ServerGoalHandle) -> Fibonacci.Result:
        """Count down in a thread of the executor, while its other threads take in new goals and cancel requests."""
        # What belongs to one goal is in local variables: two goals may be in here at once, for a moment.
        counted: list[int] = []
        for number in range(goal_handle.request.order, -1, -1):
            counted.append(number)
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=counted))
            if number > 0 and self.stopping.wait(STEP_S):
                break  # Ctrl+C: nobody will get the result.
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                self.get_logger().info(f"Canceled at {number}")
                return Fibonacci.Result(sequence=counted)
            if goal_handle is not self.newest:
                goal_handle.abort()
                self.get_logger().info(f"Replaced by a new goal at {number}")
                return Fibonacci.Result(sequence=counted)
        else:
            goal_handle.succeed()
            self.get_logger().info(f"Counted down from {goal_handle.request.order}")
        return Fibonacci.Result(sequence=counted)


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = CountdownServer()
    executor = MultiThreadedExecutor(num_threads=THREADS)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.stopping.set()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
