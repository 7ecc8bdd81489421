"""Our action client on the learner's domain, in a separate participant."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any
from uuid import uuid4

from rclpy.action.client import ActionClient
from rclpy.qos import QoSProfile
from unique_identifier_msgs.msg import UUID

from tutor.judge.trace import GoalAnswer, Sample
from tutor.ros.fields import assign
from tutor.ros.interfaces import interface_class
from tutor.ros.messages import to_plain
from tutor.ros.observer import Observer

MAX_FEEDBACK = 1000
"""Most feedback messages that are kept."""

_OUTCOMES = {4: "succeeded", 5: "canceled", 6: "aborted"}
"""The states in which a goal ends, as `action_msgs/msg/GoalStatus` numbers them."""


class GoalSender(Observer):
    """Implements `GoalClient` of `tutor.judge.peers` on real DDS. Raises UnknownType if the type is not installed.

    All of rclpy's calls are made in the executor's thread: there, no answer can come before its request is noted.
    """

    def __init__(self, domain_id: int, action: str, type_name: str, on_change: Callable[[], None]) -> None:
        self._type: Any = interface_class(type_name)
        super().__init__(domain_id, on_change)
        self._action = action
        self._handle: Any = None  # the client itself keeps it only weakly
        self._seen = GoalAnswer()
        self._client: Any = ActionClient(
            self.node,
            self._type,
            action,
            callback_group=self._gate,
        )
        self._goal_id = b""
        take: Any = self._take_feedback  # with the message's info, which rclpy's types do not know
        # Not through the client: the result may overtake feedback, and rclpy drops what comes after it.
        self._feedback = self.node.create_subscription(
            self._type.Impl.FeedbackMessage,
            f"{action}/_action/feedback",
            take,
            QoSProfile(depth=MAX_FEEDBACK),
            callback_group=self._gate,
        )
        self._executor.wake()

    @property
    def matched(self) -> bool:
        return not self._closed and bool(self._client.server_is_ready())

    @property
    def seen(self) -> GoalAnswer:
        return self._seen

    def send(self, goal: Mapping[str, Any]) -> None:
        filled = assign(self._type.Goal(), goal)
        self._executor.create_task(self._send, filled)

    def cancel(self) -> None:
        self._executor.create_task(lambda: self._handle.cancel_goal_async().add_done_callback(self._take_cancel))

    def drop_received(self) -> None:
        with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
            self._executor.create_task(self._client.destroy)
            self._executor.create_task(self.node.destroy_subscription, self._feedback)

    def close(self) -> None:
        super().close()
        self._client.destroy()

    def _send(self, goal: Any) -> None:
        self._goal_id = uuid4().bytes
        goal_id = UUID(uuid=list(self._goal_id))
        self._client.send_goal_async(goal, goal_uuid=goal_id).add_done_callback(self._take_answer)

    def _take_answer(self, done: Any) -> None:
        self._handle = done.result()
        self._call_on_loop(self._note, {"accepted": self._handle.accepted})
        if self._handle.accepted:
            self._handle.get_result_async().add_done_callback(self._take_result)

    def _take_feedback(self, message: Any, info: Any) -> None:
        if bytes(message.goal_id.uuid) != self._goal_id:  # another client's
            return
        sample = Sample(self._action, to_plain(message.feedback), info["source_timestamp"] * 1e-9, time.time())
        self._call_on_loop(self._add_feedback, sample)

    def _take_cancel(self, done: Any) -> None:
        self._call_on_loop(self._note, {"cancel_accepted": bool(done.result().goals_canceling)})

    def _take_result(self, done: Any) -> None:
        answer = done.result()
        ended = {"outcome": _OUTCOMES.get(answer.status, "unknown"), "result": to_plain(answer.result)}
        self._call_on_loop(self._note, ended)

    def _add_feedback(self, sample: Sample) -> None:
        self._note({"feedback": (*self._seen.feedback, sample)[:MAX_FEEDBACK]})

    def _note(self, changes: Mapping[str, Any]) -> None:
        self._seen = replace(self._seen, **changes)
        self._on_change()
