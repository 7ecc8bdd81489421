"""Our action server on the learner's domain, in a separate participant."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from rclpy.action.server import ActionServer, CancelResponse, GoalResponse

from tutor.judge.peers import GoalReplies
from tutor.judge.trace import ServedGoal
from tutor.ros.fields import assign
from tutor.ros.interfaces import interface_class
from tutor.ros.messages import to_plain
from tutor.ros.observer import Observer

MAX_GOALS = 100
"""Goals beyond this number are rejected, and not recorded."""

MATCH_STEPS = 10
"""For so many steps, the first feedback waits for the client's subscription: what is sent before would be lost."""


class GoalTaker(Observer):
    """Implements `GoalServer` of `tutor.judge.peers` on real DDS. Raises UnknownType if the type is not installed."""

    def __init__(
        self, domain_id: int, action: str, type_name: str, replies: GoalReplies, on_change: Callable[[], None]
    ) -> None:
        self._type: Any = interface_class(type_name)
        super().__init__(domain_id, on_change)
        self._action = action
        self._replies = replies
        self._server: Any = None
        self._goals: list[ServedGoal] = []
        self._numbers: dict[bytes, int] = {}  # of the goals, in the executor's thread

    @property
    def goals(self) -> Sequence[ServedGoal]:
        return tuple(self._goals)

    def open(self) -> None:
        # In the executor's thread: rclpy adds the server to the node before it is complete, so a goal might come early.
        self._executor.create_task(self._create)

    def _create(self) -> None:
        self._server = ActionServer(
            self.node,
            self._type,
            self._action,
            self._finish,
            goal_callback=self._decide,
            handle_accepted_callback=self._begin,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=self._gate,
        )

    def drop_received(self) -> None:
        if self._server is not None:
            with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
                self._executor.create_task(self._server.destroy)

    def close(self) -> None:
        super().close()
        if self._server is not None:
            self._server.destroy()

    def _decide(self, goal: Any) -> GoalResponse:
        accepts = self._replies.accepts and len(self._goals) < MAX_GOALS
        self._call_on_loop(self._add, ServedGoal(to_plain(goal), accepts, time.time()))
        return GoalResponse.ACCEPT if accepts else GoalResponse.REJECT

    def _begin(self, handle: Any) -> None:
        number, waited = len(self._numbers), 0
        self._numbers[bytes(handle.goal_id.uuid)] = number
        left = iter(self._replies.feedback)

        def go_on() -> None:
            nonlocal waited
            if not self.node.count_subscribers(f"{self._action}/_action/feedback") and waited < MATCH_STEPS:
                waited += 1
                return
            message = None if handle.is_cancel_requested else next(left, None)
            if message is None:
                timer.cancel()
                handle.execute()  # only now, so that nothing blocks the executor meanwhile
                return
            handle.publish_feedback(assign(self._type.Feedback(), message))
            self._call_on_loop(self._note_feedback, number)

        timer = self.node.create_timer(self._replies.step_s, go_on, callback_group=self._gate)

    def _finish(self, handle: Any) -> Any:
        if handle.is_cancel_requested:
            handle.canceled()
        else:
            handle.succeed()
        self._call_on_loop(self._note_end, self._numbers[bytes(handle.goal_id.uuid)])
        return assign(self._type.Result(), self._replies.result)

    def _add(self, goal: ServedGoal) -> None:
        self._goals.append(goal)
        self._on_change()

    def _note_feedback(self, number: int) -> None:
        self._goals[number] = replace(self._goals[number], feedback=self._goals[number].feedback + 1)
        self._on_change()

    def _note_end(self, number: int) -> None:
        self._goals[number] = replace(self._goals[number], ended=True)
        self._on_change()
