"""The bridge between rclpy and asyncio: one participant on one domain, with its executor in a separate thread."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import itertools
import math
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
from rclpy.task import Future

from tutor.judge.trace import LogRecord, Sample
from tutor.ros import memory_guard
from tutor.ros.fields import assign
from tutor.ros.intake import Intake
from tutor.ros.interfaces import interface_class
from tutor.ros.messages import is_message, kept_bytes, to_plain, to_plain_and_size, truncate
from tutor.ros.participant import OUR_PREFIX, create_node, new_context
from tutor.ros_model import QoS

ANY_PUBLISHER = QoS("best_effort", "volatile")
"""The weakest request, which every publisher's offer satisfies."""

LINE_CHARACTERS = 2000
"""Log messages are cut at this many characters, like lines of output."""

_node_numbers = itertools.count(1)


class AnswerTooLarge(Exception):
    """The response of a service is larger than what we can receive."""


class _Gate(MutuallyExclusiveCallbackGroup):
    """A callback group that holds its callbacks back while `closed`."""

    closed = False

    def can_execute(self, entity: Any) -> bool:
        return not self.closed and bool(super().can_execute(entity))  # type: ignore[no-untyped-call]


class Observer:
    """Our participant in a domain. Call its methods on the event loop's thread, unless they say otherwise.

    The executor's thread takes messages and responses and passes them to the loop with `call_soon_threadsafe`.
    `on_change` is called on the loop after each new sample, log record or fault.
    """

    def __init__(self, domain_id: int, on_change: Callable[[], None] = lambda: None, *, guarded: bool = True) -> None:
        """`guarded`: unsubscribe from what is too large to receive (see `tutor.ros.memory_guard`)."""
        self.samples: dict[str, list[Sample]] = {}
        self.logs: list[LogRecord] = []
        self.fault: Exception | None = None
        self._loop = asyncio.get_running_loop()
        self._on_change = on_change
        self._clients: dict[tuple[str, str], Client] = {}
        self._servers: list[ServiceServer] = []
        self._pending_answers: set[asyncio.Future[Any]] = set()
        self._pending_large_answers = 0
        self._gate: _Gate = _Gate()  # type: ignore[no-untyped-call]
        self._intakes: list[Intake] = []
        self._closed = False
        threads = memory_guard.threads()
        self._context = new_context(domain_id)
        self.node = create_node(self._context, f"{OUR_PREFIX}_{next(_node_numbers)}")
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
                truncate(field, LINE_CHARACTERS) for field in (message.msg, message.name, message.function)
            )
            self._call_on_loop(self._add_log, LogRecord(level, name, text, stamp, time.time(), function))
            return kept_bytes(message.msg, text)

        qos = QoS("reliable", "transient_local")
        self._intakes.append(Intake(self.node, "/rosout", "rcl_interfaces/msg/Log", qos, self._gate, take))

    def watch(self, topic: str, type_name: str, requested: QoS = ANY_PUBLISHER) -> None:
        """Collect the samples of a topic in `samples`. Raises UnknownType."""
        interface_class(type_name)
        self.samples[topic] = []

        def take(message: Any, source_time: float) -> int:
            plain, cost = to_plain_and_size(message)
            self._call_on_loop(self._add_sample, Sample(topic, plain, source_time, time.time()))
            return cost

        self._intakes.append(Intake(self.node, topic, type_name, requested, self._gate, take))

    def serve(
        self,
        service: str,
        type_name: str,
        handler: Callable[[Mapping[str, Any]], Mapping[str, Any]],
        on_served: Callable[[Mapping[str, Any], Mapping[str, Any]], None],
    ) -> None:
        """Serve a service with `handler`, which runs in the executor's thread; `on_served` is called on the loop."""

        def answer(request: Any, response: Any) -> Any:
            plain_request = to_plain(request)
            values = handler(plain_request)
            self._call_on_loop(on_served, plain_request, values)
            return assign(response, values)

        # rclpy warns on stderr about a client that ended before its response; that is not our fault.
        warnings.filterwarnings("ignore", "failed to send response", RuntimeWarning)
        self._servers.append(
            self.node.create_service(interface_class(type_name), service, answer, callback_group=self._gate)
        )

    async def call(
        self,
        service: str,
        type_name: str,
        request: Any,
        limit_s: float,
        *,
        large: bool = False,
        resend_s: float = math.inf,
    ) -> Any | None:
        """Call a service once its server is matched. Return None if no response arrives within `limit_s` seconds.

        `request`: a message, or a mapping of its fields.
        `large`: the response may be of any size. `resend_s`: send the request again whenever this many seconds pass
        without a response, for requests without side effects. The middleware drops the response to a client that the
        server has not fully discovered within 0.1 s, which happens on a busy machine. Raises AnswerTooLarge.
        """
        deadline = self._loop.time() + limit_s
        if not await self.wait_for_server(service, type_name, limit_s):
            return None
        client = self._client(service, type_name)
        filled = request if is_message(request) else assign(interface_class(type_name).Request(), request)
        answer: asyncio.Future[Any] = self._loop.create_future()
        pending: list[Future] = []
        self._pending_answers.add(answer)
        self._pending_large_answers += large
        try:
            while not answer.done() and not self._closed and (left_s := deadline - self._loop.time()) > 0:
                sent = client.call_async(filled)
                sent.add_done_callback(lambda done: self._call_on_loop(_transfer_result, answer, done))
                pending.append(sent)
                await asyncio.wait({answer}, timeout=min(left_s, resend_s))
            return answer.result() if answer.done() else None
        finally:  # the caller may be cancelled
            self._pending_answers.discard(answer)
            self._pending_large_answers -= large
            for sent in pending:
                if not sent.done():
                    client.remove_pending_request(sent)

    def discard_client(self, service: str, type_name: str) -> None:
        """Destroy our client of a service: it keeps the memory of its largest response. The next call makes another."""
        if client := self._clients.pop((service, type_name), None):
            self._executor.create_task(self.node.destroy_client, client)

    async def wait_for_server(self, service: str, type_name: str, limit_s: float) -> bool:
        """Wait until our client has discovered the server. Return False if it has not within `limit_s` seconds.

        Also return False once the observer is closed: a check may still ask a node while another part of it ends.
        """
        deadline = self._loop.time() + limit_s
        while not self._closed and not self._client(service, type_name).service_is_ready():
            if self._loop.time() >= deadline:
                return False
            await asyncio.sleep(0.005)
        return not self._closed

    def pause(self, paused: bool) -> None:
        """Stop or resume taking received messages. May be called from any thread."""
        if self._gate.closed != paused:
            self._gate.closed = paused
            with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
                self._executor.wake()

    async def wait_while_paused(self, limit_s: float) -> None:
        """Wait while paused, for up to `limit_s` seconds."""
        deadline = self._loop.time() + limit_s
        while self._gate.closed and self._loop.time() < deadline:
            await asyncio.sleep(0.01)

    def drop_received(self) -> None:
        """Drop all services if a large response is pending or there are no topics, else all topics.

        May be called from any thread. The endpoints are destroyed in the executor's thread, where messages are taken.
        """
        actions: list[Callable[[], object]] = [intake.unsubscribe for intake in self._intakes]
        if actions and not self._pending_large_answers:
            self._intakes = []
        else:
            clients, self._clients = self._clients, {}
            actions = [functools.partial(self.node.destroy_client, client) for client in clients.values()]
            actions += [functools.partial(self.node.destroy_service, server) for server in self._servers]
            self._call_on_loop(self._refuse_answers)
        with contextlib.suppress(AttributeError):  # the executor has been shut down meanwhile
            for action in actions:
                self._executor.create_task(action)

    def close(self) -> None:
        """Leave the domain. Idempotent."""
        if self._closed:
            return
        self._closed = True
        memory_guard.release(self)
        self._executor.shutdown(timeout_sec=0)
        self._context.try_shutdown()
        self._thread.join(5.0)
        self.node.destroy_node()

    def _refuse_answers(self) -> None:
        for answer in self._pending_answers:
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
        except Exception as error:  # nothing else would catch an error in this thread: report it on the loop
            if not self._closed:
                self._call_on_loop(self._set_fault, error)

    def _call_on_loop(self, callback: Callable[..., None], *args: Any) -> None:
        try:
            self._loop.call_soon_threadsafe(callback, *args)
        except RuntimeError:  # the loop is closed
            if not self._closed:
                raise

    def _add_sample(self, sample: Sample) -> None:
        self.samples[sample.topic].append(sample)
        self._on_change()

    def _add_log(self, record: LogRecord) -> None:
        self.logs.append(record)
        self._on_change()

    def _set_fault(self, error: Exception) -> None:
        self.fault = error
        self._on_change()


def _transfer_result(answer: asyncio.Future[Any], done: Any) -> None:
    if answer.done():
        return
    if (error := done.exception()) is not None:
        answer.set_exception(error)
    else:
        answer.set_result(done.result())
