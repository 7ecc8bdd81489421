"""The bridge between rclpy and asyncio: one participant on one domain, with its executor in a thread of its own."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import itertools
import threading
import time
import warnings
from collections.abc import Callable, Mapping
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.client import Client
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import qos_profile_services_default
from rclpy.service import Service as ServiceServer

from tutor.judge.trace import LogRecord, Sample
from tutor.ros import memory_guard
from tutor.ros.intake import Intake
from tutor.ros.messages import interface_class, kept_bytes, set_fields, to_plain, to_plain_and_size, truncate
from tutor.ros.participant import OUR_PREFIX, create_node, new_context
from tutor.ros_model import QoS

ANY_PUBLISHER = QoS("best_effort", "volatile")
"""What every publisher offers at least."""

LINE_CHARACTERS = 2000
"""A log message is cut at this many characters, as a line of the output is."""

_number = itertools.count(1)


class AnswerTooLarge(Exception):
    """The answer to a request is larger than what may be received."""


class _Gate(MutuallyExclusiveCallbackGroup):
    """What is received is taken while it is open."""

    closed = False

    def can_execute(self, entity: Any) -> bool:
        return not self.closed and bool(super().can_execute(entity))  # type: ignore[no-untyped-call]


class Observer:
    """Our participant in a domain. Every method is called on the event loop's thread; facts arrive there too.

    `on_change` is called (on that thread) after each new fact. Messages and answers are taken in the executor's thread
    and handed over with `call_soon_threadsafe`.
    """

    def __init__(self, domain_id: int, on_change: Callable[[], None] = lambda: None, *, guarded: bool = True) -> None:
        """`guarded`: it leaves what is too large to be received (see `tutor.ros.memory_guard`)."""
        self.samples: dict[str, list[Sample]] = {}
        self.logs: list[LogRecord] = []
        self.fault: Exception | None = None
        self._loop = asyncio.get_running_loop()
        self._on_change = on_change
        self._clients: dict[tuple[str, str], Client] = {}
        self._servers: list[ServiceServer] = []
        self._answers: set[asyncio.Future[Any]] = set()
        self._large_answers = 0
        self._gate: _Gate = _Gate()  # type: ignore[no-untyped-call]
        self._intakes: list[Intake] = []
        self._closed = False
        threads = memory_guard.threads()
        self._context = new_context(domain_id)
        self.node = create_node(self._context, f"{OUR_PREFIX}_{next(_number)}")
        self.threads = memory_guard.threads() - threads
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._spin, name=f"observer-{domain_id}", daemon=True)
        self._thread.start()
        if guarded:
            memory_guard.guard(self)

    def watch_logs(self) -> None:
        """Subscribe to `/rosout`, including earlier messages (it is transient local)."""

        def take(message: Any, _source_time: float) -> int:
            stamp = message.stamp.sec + message.stamp.nanosec * 1e-9
            level = message.level if isinstance(message.level, int) else message.level[0]
            text, name, function = (
                truncate(each, LINE_CHARACTERS) for each in (message.msg, message.name, message.function)
            )
            self._hand_to_loop(self._log, LogRecord(level, name, text, stamp, time.time(), function))
            return kept_bytes(message.msg, text)

        qos = QoS("reliable", "transient_local")
        self._intakes.append(Intake(self.node, "/rosout", "rcl_interfaces/msg/Log", qos, self._gate, take))

    def watch(self, topic: str, type_name: str, requested: QoS = ANY_PUBLISHER) -> None:
        """Collect the samples of a topic. Raises UnknownType."""
        interface_class(type_name)
        self.samples[topic] = []

        def take(message: Any, source_time: float) -> int:
            plain, cost = to_plain_and_size(message)
            self._hand_to_loop(self._sample, Sample(topic, plain, source_time, time.time()))
            return cost

        self._intakes.append(Intake(self.node, topic, type_name, requested, self._gate, take))

    def serve(
        self,
        service: str,
        type_name: str,
        handler: Callable[[Mapping[str, Any]], Mapping[str, Any]],
        on_served: Callable[[Mapping[str, Any], Mapping[str, Any]], None],
    ) -> None:
        """Answer a service with `handler`; `on_served(request, response)` is called on the loop's thread."""

        def answer(request: Any, response: Any) -> Any:
            asked = to_plain(request)
            answered = handler(asked)
            self._hand_to_loop(on_served, asked, answered)
            return set_fields(response, answered)

        # Of a client that ended before its answer, rclpy warns on stderr; it is no fault of ours.
        warnings.filterwarnings("ignore", "failed to send response", RuntimeWarning)
        self._servers.append(
            self.node.create_service(interface_class(type_name), service, answer, callback_group=self._gate)
        )

    async def call(
        self, service: str, type_name: str, request: Mapping[str, Any], limit_s: float, *, large: bool = False
    ) -> Any | None:
        """Call a service once its server is matched; None where no answer came within the limit.

        `large`: that its answer may be of any size is to be expected. Raises AnswerTooLarge.
        """
        deadline = self._loop.time() + limit_s
        if not await self.wait_for_server(service, type_name, limit_s):
            return None
        client = self._client(service, type_name)
        filled = set_fields(interface_class(type_name).Request(), request)
        answer: asyncio.Future[Any] = self._loop.create_future()
        pending = client.call_async(filled)
        pending.add_done_callback(lambda done: self._hand_to_loop(_settle, answer, done))
        self._answers.add(answer)
        self._large_answers += large
        try:
            return await asyncio.wait_for(answer, max(0.0, deadline - self._loop.time()))
        except TimeoutError:
            return None
        finally:  # the caller may be cancelled
            self._answers.discard(answer)
            self._large_answers -= large
            if not pending.done():
                client.remove_pending_request(pending)

    def forget(self, service: str, type_name: str) -> None:
        """Make another client for the next call: one keeps the memory of the largest answer that it has had."""
        if client := self._clients.pop((service, type_name), None):
            self._executor.create_task(self.node.destroy_client, client)

    async def wait_for_server(self, service: str, type_name: str, limit_s: float) -> bool:
        """Wait until our client has discovered the server; False where it has not within the limit."""
        client = self._client(service, type_name)
        deadline = self._loop.time() + limit_s
        while not client.service_is_ready():
            if self._loop.time() >= deadline:
                return False
            await asyncio.sleep(0.005)
        return True

    def pause(self, paused: bool) -> None:
        """Take nothing of what has been received, or take it again. Called in any thread."""
        if self._gate.closed != paused:
            self._gate.closed = paused
            with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
                self._executor.wake()

    async def wait_while_paused(self, limit_s: float) -> None:
        """Wait while nothing is taken of what has been received."""
        deadline = self._loop.time() + limit_s
        while self._gate.closed and self._loop.time() < deadline:
            await asyncio.sleep(0.01)

    def drop_received(self) -> None:
        """Leave the services of which a large answer is awaited, or else the topics, or else all services.

        Called in any thread. What is left is left where messages are taken, too.
        """
        left: list[Callable[[], object]] = [intake.leave for intake in self._intakes]
        if left and not self._large_answers:
            self._intakes = []
        else:
            clients, self._clients = self._clients, {}
            left = [functools.partial(self.node.destroy_client, client) for client in clients.values()]
            left += [functools.partial(self.node.destroy_service, server) for server in self._servers]
            self._hand_to_loop(self._refuse_answers)
        with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
            for leave in left:
                self._executor.create_task(leave)

    def close(self) -> None:
        """Leave the domain. Safe to call twice."""
        if self._closed:
            return
        self._closed = True
        memory_guard.release(self)
        self._executor.shutdown(timeout_sec=0)
        self._context.try_shutdown()
        self._thread.join(5.0)
        self.node.destroy_node()

    def _refuse_answers(self) -> None:
        for answer in self._answers:
            if not answer.done():
                answer.set_exception(AnswerTooLarge())

    def _client(self, service: str, type_name: str) -> Client:
        key = (service, type_name)
        if key not in self._clients:
            self._clients[key] = self.node.create_client(
                interface_class(type_name), service, qos_profile=qos_profile_services_default, callback_group=self._gate
            )
            self._executor.wake()
        return self._clients[key]

    def _spin(self) -> None:
        try:
            while self._context.ok():
                self._executor.spin_once()
        except ExternalShutdownException:
            pass
        except Exception as error:  # the thread's boundary: any error is reported on the loop's thread
            if not self._closed:
                self._hand_to_loop(self._fail, error)

    def _hand_to_loop(self, callback: Callable[..., None], *args: Any) -> None:
        try:
            self._loop.call_soon_threadsafe(callback, *args)
        except RuntimeError:  # the loop is closed
            if not self._closed:
                raise

    def _sample(self, sample: Sample) -> None:
        self.samples[sample.topic].append(sample)
        self._on_change()

    def _log(self, record: LogRecord) -> None:
        self.logs.append(record)
        self._on_change()

    def _fail(self, error: Exception) -> None:
        self.fault = error
        self._on_change()


def _settle(answer: asyncio.Future[Any], done: Any) -> None:
    if answer.done():
        return
    if (error := done.exception()) is not None:
        answer.set_exception(error)
    else:
        answer.set_result(done.result())
