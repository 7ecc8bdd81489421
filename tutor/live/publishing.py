"""Publishing by hand: a message once, or at a fixed rate until stopped."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from tutor.errors import UnknownType
from tutor.live.protocol import Publish
from tutor.live.updates import PublishStatus
from tutor.ros.manual_publisher import ManualPublisher

CONNECT_S = 2.0
"""How long a new publisher waits for subscriptions to match before it publishes anyway."""

LINGER_S = 1.0
"""How long a publisher stays after a single message, which may get lost if it leaves at once."""

REPORT_INTERVAL_S = 0.5
MAX_RATE_HZ = 1000.0

_POLL_S = 0.02


class Publishing:
    """Publishes one message per topic. `send` receives the status, at most every `REPORT_INTERVAL_S` seconds.

    `expect` is called with a topic and its type before publishing; it returns whether we subscribe to the topic too.
    """

    def __init__(
        self,
        manual_publisher: ManualPublisher,
        expect: Callable[[str, str], bool],
        send: Callable[[PublishStatus], object],
    ) -> None:
        self._manual_publisher = manual_publisher
        self._expect = expect
        self._send = send
        self._running: dict[str, asyncio.Task[None]] = {}

    async def begin(self, request: Publish) -> None:
        """Start publishing, replacing what we currently publish on the topic."""
        await self.end(request.topic)
        self._running[request.topic] = asyncio.create_task(self._run(request))

    async def end(self, topic: str) -> None:
        """Stop publishing on a topic."""
        if (task := self._running.pop(topic, None)) is not None:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def _run(self, request: Publish) -> None:
        sent, problem = 0, ""

        def report(over: bool) -> None:
            listeners = self._manual_publisher.listeners(request.topic)
            update = PublishStatus(
                request.topic, request.type, request.rate_hz, sent, listeners, time.time(), over, problem
            )
            self._send(update)

        try:
            self._manual_publisher.add(request.topic, request.type, request.values)
            await self._connect(request.topic, self._expect(request.topic, request.type))
            began, reported_at = time.perf_counter(), 0.0
            while sent == 0 or request.rate_hz:
                self._manual_publisher.publish(request.topic)
                sent += 1
                if request.rate_hz and time.perf_counter() >= reported_at + REPORT_INTERVAL_S:
                    reported_at = time.perf_counter()
                    report(over=False)
                if request.rate_hz:
                    due = began + sent / min(request.rate_hz, MAX_RATE_HZ)
                    await asyncio.sleep(max(0.0, due - time.perf_counter()))
            report(over=False)
            await asyncio.sleep(LINGER_S)
        except UnknownType:
            problem = f"This ROS does not have the type {request.type}."
        except ValueError as error:
            problem = str(error)
        finally:
            report(over=True)
            self._manual_publisher.remove(request.topic)

    async def _connect(self, topic: str, ours: bool) -> None:
        deadline = time.monotonic() + CONNECT_S
        while not self._manual_publisher.is_connected(topic, ours) and time.monotonic() < deadline:
            await asyncio.sleep(_POLL_S)
