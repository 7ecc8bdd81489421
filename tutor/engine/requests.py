"""Our requests to the learner's nodes: their parameters, and calls of their services, each with a time limit."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

from tutor.engine.waits import Waits
from tutor.judge.trace import CallAnswer, SetAnswer
from tutor.ros import parameters
from tutor.ros.messages import to_plain
from tutor.ros.observer import AnswerTooLarge, Observer
from tutor.ros_model import Parameter

NO_TIMEOUT_S = 1e6
"""Timeout of a request whose time limit `Waits` enforces."""


class Requests:
    """Sends requests in the observer's node, each as the method of this name of `tutor.judge.bench.Run` says.

    A limit is in seconds, and longer while the machine does not let the process run.
    """

    def __init__(self, observer: Observer, waits: Waits) -> None:
        self._observer, self._waits = observer, waits

    async def parameters(self, nodes: Iterable[str], limit_s: float) -> tuple[Parameter, ...] | None:
        """Ask these nodes for their parameters; None if none of them answered within the limit."""
        # One task per node, so that one that never answers does not hide the others. Each makes up to three requests.
        answers = await asyncio.gather(
            *(
                self._waits.for_response(
                    partial(parameters.get_parameters, self._observer, [node], NO_TIMEOUT_S),
                    2 * limit_s,
                    None,
                    resend_s=parameters.RESEND_S,
                )
                for node in nodes
            )
        )
        answered = [answer for answer in answers if answer is not None]
        return tuple(parameter for answer in answered for parameter in answer) if answered else None

    async def set_parameters(self, node: str, values: Mapping[str, Any], *, atomic: bool, limit_s: float) -> SetAnswer:
        """Set parameters of a node; with `atomic`, all in one atomic request."""
        asked = time.time()
        answer = await self._waits.for_response(
            partial(parameters.set_parameters, self._observer, node, values, atomic=atomic, limit_s=NO_TIMEOUT_S),
            limit_s,
            None,
        )
        return answer or SetAnswer(values, False, False, "", asked, time.time())

    async def call(
        self,
        service: str,
        type: str,
        request: Mapping[str, Any],
        *,
        limit_s: float,
        resend_s: float,
        all_sent: Callable[[], bool],
    ) -> CallAnswer:
        """Call a service with a new client, once it is matched with the server."""
        # A new client needs a moment to discover the server, which is no part of the service's response time.
        asked = time.time()
        if matched := await self._waits.for_response(
            partial(self._observer.wait_for_server, service, type, NO_TIMEOUT_S), limit_s, False
        ):
            asked = time.time()
        response = None
        with contextlib.suppress(AnswerTooLarge):
            if matched:
                response = await self._waits.for_response(
                    partial(self._observer.call, service, type, request, NO_TIMEOUT_S, resend_s=resend_s),
                    limit_s,
                    None,
                    resend_s=resend_s,
                    all_sent=all_sent,
                )
        return CallAnswer(
            service=service,
            request=dict(request),
            response=None if response is None else to_plain(response),
            asked_at=asked,
            answered_at=time.time(),
        )
