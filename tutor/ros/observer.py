"""The bridge between rclpy and asyncio: one participant on one domain, with its executor in a thread of its own."""

from __future__ import annotations

import asyncio
import itertools
import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from rclpy.client import Client
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import qos_profile_services_default
from rclpy.service import Service as ServiceServer

from tutor.judge.trace import LogRecord, Sample
from tutor.ros.messages import cut, interface_class, plain_and_size, set_fields, size_kept, to_plain
from tutor.ros.participant import OUR_PREFIX, create_node, new_context
from tutor.ros.qos import subscription_profile
from tutor.ros_model import QoS

ANY_PUBLISHER = QoS("best_effort", "volatile")
"""What every publisher offers at least."""

QUEUE_DEPTH = 1000
"""Queue depth of our subscriptions: a default-QoS subscriber can lose a burst that this one gets whole."""

MOST_SAMPLES = 20_000
"""A topic is no longer listened to after this many samples: a flood must not exhaust us."""

MOST_BYTES = 8_000_000
"""Nor after this many bytes."""

LINE_CHARACTERS = 2000
"""A log message is cut at this many characters, as a line of the output is."""

_number = itertools.count(1)


class Observer:
    """A participant of ours. Every method is called on the event loop's thread; facts arrive there too.

    `on_change` is called (on that thread) after each new fact. Messages and answers are taken in the executor's thread
    and handed over with `call_soon_threadsafe`.
    """

    def __init__(self, domain_id: int, on_change: Callable[[], None] = lambda: None) -> None:
        self.samples: dict[str, list[Sample]] = {}
        self.logs: list[LogRecord] = []
        self.fault: Exception | None = None
        self._loop = asyncio.get_running_loop()
        self._on_change = on_change
        self._clients: dict[tuple[str, str], Client] = {}
        self._servers: list[ServiceServer] = []
        self._closed = False
        self._context = new_context(domain_id)
        self.node = create_node(self._context, f"{OUR_PREFIX}_{next(_number)}")
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._spin, name=f"observer-{domain_id}", daemon=True)
        self._thread.start()

    def watch_logs(self) -> None:
        """Subscribe to `/rosout`, including earlier messages (it is transient local)."""
        qos = subscription_profile(QoS("reliable", "transient_local"), QUEUE_DEPTH)

        def take(message: Any) -> None:
            stamp = message.stamp.sec + message.stamp.nanosec * 1e-9
            level = message.level if isinstance(message.level, int) else message.level[0]
            text, name, function = (
                cut(each, LINE_CHARACTERS) for each in (message.msg, message.name, message.function)
            )
            self._hand_to_loop(self._log, LogRecord(level, name, text, stamp, time.time(), function))
            count(size_kept(message.msg, text))

        count = self._counter(lambda: self.node.destroy_subscription(subscription))
        subscription = self.node.create_subscription(interface_class("rcl_interfaces/msg/Log"), "/rosout", take, qos)

    def watch(self, topic: str, type_name: str, requested: QoS = ANY_PUBLISHER) -> None:
        """Collect the samples of a topic. Raises UnknownType."""
        message_type = interface_class(type_name)
        self.samples[topic] = []
        qos = subscription_profile(requested, QUEUE_DEPTH)

        def take(message: Any, info: Any) -> None:
            plain, cost = plain_and_size(message)
            source = info["source_timestamp"] * 1e-9
            self._hand_to_loop(self._sample, Sample(topic, plain, source, time.time()))
            count(cost)

        # rclpy gives the message's info to a callback that takes two arguments; its annotations know one only.
        callback: Any = take
        count = self._counter(lambda: self.node.destroy_subscription(subscription))
        subscription = self.node.create_subscription(message_type, topic, callback, qos)

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

        self._servers.append(self.node.create_service(interface_class(type_name), service, answer))

    async def call(self, service: str, type_name: str, request: Mapping[str, Any], limit_s: float) -> Any | None:
        """Call a service once its server is matched; None where no answer came within the limit."""
        deadline = self._loop.time() + limit_s
        if not await self.matched(service, type_name, limit_s):
            return None
        client = self._client(service, type_name)
        filled = set_fields(interface_class(type_name).Request(), request)
        answer: asyncio.Future[Any] = self._loop.create_future()
        pending = client.call_async(filled)
        pending.add_done_callback(lambda done: self._hand_to_loop(_settle, answer, done))
        try:
            return await asyncio.wait_for(answer, max(0.0, deadline - self._loop.time()))
        except TimeoutError:
            return None
        finally:  # the caller may be cancelled
            if not pending.done():
                client.remove_pending_request(pending)

    async def matched(self, service: str, type_name: str, limit_s: float) -> bool:
        """Wait until our client has discovered the server; False where it has not within the limit."""
        client = self._client(service, type_name)
        deadline = self._loop.time() + limit_s
        while not client.service_is_ready():
            if self._loop.time() >= deadline:
                return False
            await asyncio.sleep(0.005)
        return True

    def close(self) -> None:
        """Leave the domain. Safe to call twice."""
        if self._closed:
            return
        self._closed = True
        self._executor.shutdown(timeout_sec=0)
        self._context.try_shutdown()
        self._thread.join(5.0)
        self.node.destroy_node()

    def _client(self, service: str, type_name: str) -> Client:
        key = (service, type_name)
        if key not in self._clients:
            self._clients[key] = self.node.create_client(
                interface_class(type_name), service, qos_profile=qos_profile_services_default
            )
            self._executor.wake()
        return self._clients[key]

    def _counter(self, leave: Callable[[], object]) -> Callable[[int], None]:
        """Counts the messages and bytes of one topic; calls `leave` at the limit."""
        messages = kept = 0

        def count(cost: int) -> None:
            nonlocal messages, kept
            messages, kept = messages + 1, kept + cost
            if messages >= MOST_SAMPLES or kept > MOST_BYTES:
                leave()

        return count

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
