"""Our server of one service on the learner's domain, in a separate participant, which replies when it is told to."""

from __future__ import annotations

import contextlib
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from tutor.judge.trace import HeldRequest
from tutor.ros.fields import assign
from tutor.ros.interfaces import interface_class
from tutor.ros.messages import to_plain
from tutor.ros.observer import Observer

MAX_REQUESTS = 1000
"""Most requests that are taken; those after them get no reply."""


class HeldService(Observer):
    """Implements `HoldingServer` of `tutor.judge.peers` on real DDS. Raises UnknownType if the type is not installed.

    A request is held by a coroutine of the executor, which awaits the reply; so it keeps no thread.
    """

    def __init__(self, domain_id: int, service: str, type_name: str, on_change: Callable[[], None]) -> None:
        self._type: Any = interface_class(type_name)
        super().__init__(domain_id, on_change)
        self._requests: list[HeldRequest] = []
        self._replies: list[Future] = []
        # rclpy warns on stderr about a client that ended before its response; that is not our fault.
        warnings.filterwarnings("ignore", "failed to send response", RuntimeWarning)
        group = ReentrantCallbackGroup()
        self._server = self.node.create_service(self._type, service, self._hold, callback_group=group)
        self._executor.wake()

    @property
    def requests(self) -> Sequence[HeldRequest]:
        return self._requests

    def reply(self, request: HeldRequest, response: Mapping[str, Any]) -> None:
        answer = self._replies[request.number]
        if not answer.done():
            answer.set_result(assign(self._type.Response(), response))
            with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
                self._executor.wake()

    def drop_received(self) -> None:
        with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
            self._executor.create_task(self.node.destroy_service, self._server)

    async def _hold(self, request: Any, response: Any) -> Any:
        answer = Future()
        self._call_on_loop(self._note, to_plain(request), time.time(), answer)
        return await answer

    def _note(self, request: Mapping[str, Any], at: float, answer: Future) -> None:
        if len(self._requests) < MAX_REQUESTS:
            self._requests.append(HeldRequest(len(self._requests), request, at))
            self._replies.append(answer)
            self._on_change()
