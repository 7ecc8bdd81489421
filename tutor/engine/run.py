"""One run of the learner's process, with everything that an observer on its domain sees of it."""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

from tutor.engine import ending, source
from tutor.engine.requests import Requests
from tutor.engine.waits import POLL_S, CollectedFacts, Waits
from tutor.errors import EngineError, UnknownType
from tutor.judge.peers import GoalReplies, Handler
from tutor.judge.trace import (
    CallAnswer,
    Echo,
    Ending,
    Exit,
    LogRecord,
    OutputLine,
    Sample,
    ServedRequest,
    SetAnswer,
    Trace,
)
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import RESENT_S
from tutor.process import LearnerProcess, next_wake, own_cpu_time
from tutor.ros import echo, graph
from tutor.ros.goal_sender import GoalSender
from tutor.ros.goal_taker import GoalTaker
from tutor.ros.held_service import HeldService
from tutor.ros.intake import MAX_SAMPLES
from tutor.ros.observer import ANY_PUBLISHER, Observer
from tutor.ros.talker import Talker
from tutor.ros_model import Graph, Parameter, echo_qos

ROS_ARGUMENTS = "--ros-args"
"""The launch system passes this to every node, whether it has any such arguments or not."""


class RosRun:
    """The `Run` of `tutor.judge.bench`, on a real process and real DDS."""

    def __init__(
        self,
        path: Path,
        given: Mapping[str, Any],
        domain_id: int,
        process: LearnerProcess,
        observer: Observer,
        facts: CollectedFacts,
        unbuilt: Mapping[str, str],
        talkers: Mapping[str, Talker],
    ) -> None:
        self._path = path
        self._talkers = talkers
        self._given = dict(given)
        self._domain_id = domain_id
        self._process = process
        self._observer = observer
        self._facts = facts
        self._unbuilt = unbuilt
        self._graph: tuple[float, Graph] = (0.0, Graph())
        self._waits = Waits(process, observer, facts.changed, self._is_known)
        self._requests = Requests(observer, self._waits)
        self.interrupted_at: float | None = None
        """When Ctrl+C was pressed, in seconds since the epoch."""

    @property
    def awaits_response(self) -> bool:
        """Whether one of our requests is waiting for its response."""
        return self._waits.awaits_response

    @property
    def started_at(self) -> float:
        return self._process.started_at

    @property
    def logs(self) -> Sequence[LogRecord]:
        return self._observer.logs

    @property
    def graph(self) -> Graph:
        read_at, seen = self._graph
        now = time.monotonic()
        if now - read_at >= POLL_S:
            seen = graph.read_graph(self._observer.node)
            self._graph = (now, seen)
        return seen

    def peek_graph(self) -> Graph:
        """The current graph, for preliminary findings. It is not kept as the last one, so it affects no verdict."""
        read_at, seen = self._graph
        if self.exit is not None or time.monotonic() - read_at < POLL_S:
            return seen
        return graph.read_graph(self._observer.node)

    def _is_known(self) -> bool:
        """Whether a node of the process has been discovered, or anything received from it."""
        return bool(self._graph[1].nodes or self.graph.nodes or self.logs or any(self._observer.samples.values()))

    @property
    def exit(self) -> Exit | None:
        return self._process.exit

    @property
    def output(self) -> Sequence[OutputLine]:
        return self._process.output

    @property
    def served(self) -> Sequence[ServedRequest]:
        return self._facts.served

    def samples_on(self, topic: str) -> Sequence[Sample]:
        return self._observer.samples.get(topic, [])

    def watch(self, topic: str, type: str) -> bool:
        if topic in self._observer.samples:
            return True
        offered = echo_qos(publisher.qos for publisher in self.graph.publishers if publisher.topic == topic)
        # Samples published before we subscribed are delivered only by a transient-local publisher.
        requested = offered if offered.durability == "transient_local" else ANY_PUBLISHER
        try:
            self._observer.watch(topic, type, requested)
        except UnknownType:
            return False
        return True

    def serve(self, service: str, type: str, handler: Handler) -> None:
        def record(request: Mapping[str, Any], response: Mapping[str, Any]) -> None:
            if len(self._facts.served) < MAX_SAMPLES:
                self._facts.served.append(ServedRequest(service, request, response, time.time()))
            self._facts.notify()

        self._observer.serve(service, type, handler, record)

    def now(self) -> float:
        return time.time()

    def node_cpu_wait_s(self) -> float:
        return self._waits.cpu_time().waited_s

    def our_cpu_wait_s(self) -> float:
        return own_cpu_time().waited_s

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        return await self._waits.until(seen, limit_s, idle_s=idle_s)

    async def wait_for_exit(
        self,
        limit_s: float,
        *,
        meanwhile: Callable[[], object] = lambda: None,
        all_sent: Callable[[], bool] = lambda: False,
        given_up: Callable[[], bool] = lambda: False,
    ) -> bool:
        return await self._waits.for_exit(limit_s, meanwhile, all_sent, given_up)

    async def parameters(self, limit_s: float) -> tuple[Parameter, ...] | None:
        return await self._requests.parameters(self.graph.parameter_nodes, limit_s)

    async def set_parameters(
        self, node: str, values: Mapping[str, Any], *, atomic: bool = False, limit_s: float = 5.0
    ) -> SetAnswer:
        return await self._requests.set_parameters(node, values, atomic=atomic, limit_s=limit_s)

    async def call(
        self,
        service: str,
        type: str,
        request: Mapping[str, Any],
        *,
        limit_s: float,
        resend_s: float = math.inf,
        all_sent: Callable[[], bool] = lambda: True,
    ) -> CallAnswer:
        return await self._requests.call(service, type, request, limit_s=limit_s, resend_s=resend_s, all_sent=all_sent)

    @asynccontextmanager
    async def publisher(self, topic: str, type: str) -> AsyncIterator[Talker]:
        with contextlib.closing(Talker(self._domain_id, topic, type)) as talker:
            yield talker

    def offered(self, topic: str) -> Talker:
        return self._talkers[topic]

    @asynccontextmanager
    async def goal_client(self, action: str, type: str) -> AsyncIterator[GoalSender]:
        with contextlib.closing(GoalSender(self._domain_id, action, type, self._facts.notify)) as client:
            yield client
            if client.fault is not None:
                raise EngineError(f"watching the action failed: {client.fault}")

    @asynccontextmanager
    async def goal_server(self, action: str, type: str, replies: GoalReplies) -> AsyncIterator[GoalTaker]:
        with contextlib.closing(GoalTaker(self._domain_id, action, type, replies, self._facts.notify)) as server:
            yield server
            if server.fault is not None:
                raise EngineError(f"serving the action failed: {server.fault}")

    @asynccontextmanager
    async def holding_server(self, service: str, type: str) -> AsyncIterator[HeldService]:
        with contextlib.closing(HeldService(self._domain_id, service, type, self._facts.notify)) as server:
            yield server
            if server.fault is not None:
                raise EngineError(f"serving {service} failed: {server.fault}")

    async def echo(self, topic: str, *, samples: int, limit_s: float) -> Echo:
        over = asyncio.Event()
        echoing = asyncio.ensure_future(echo.echo_topic(self._domain_id, topic, samples=samples, over=over))
        echoing.add_done_callback(lambda _: self._facts.notify())
        try:
            await self.until(echoing.done, limit_s, idle_s=RESENT_S)
            over.set()
            shown = await echoing
        finally:
            echoing.cancel()
        # The real echo reads a graph that has long settled; our new participant may not have discovered all publishers.
        settled = {endpoint.type for endpoint in self.graph.publishers if endpoint.topic == topic}
        return replace(shown, types=tuple(sorted(settled.union(shown.types))))

    async def interrupt(self, limit_s: float = 5.0) -> Ending | None:
        await ending.wait_until_blocked(self._process, self.node_cpu_wait_s)
        if self._has_lost_its_nodes():  # it is on its way out
            await self.wait_for_exit(limit_s, all_sent=lambda: True)
        if self.exit is not None:
            return None
        self.interrupted_at = time.time()
        cpu_wait_share = self.node_cpu_wait_s() / max(self.interrupted_at - self.started_at, POLL_S)
        self._process.interrupt()
        await self.wait_for_exit(limit_s)
        return await ending.ending_of(self._process, self.interrupted_at, limit_s, cpu_wait_share)

    def _has_lost_its_nodes(self) -> bool:
        had_nodes = self.exit is None and bool(self._graph[1].nodes)
        return had_nodes and not graph.read_graph(self._observer.node).nodes

    def command_lines(self) -> tuple[str, ...]:
        return tuple(survivor.command for survivor in self._process.survivors())

    def has_launched_all(self) -> bool:
        if next_wake([self._process.pid]).at != math.inf:  # first, as it does not read the whole process table
            return False
        children = [survivor.command for survivor in self._process.survivors() if survivor.pid != self._process.pid]
        return len(children) <= len(self.graph.nodes) and all(ROS_ARGUMENTS in command.split() for command in children)

    async def dump_stacks(self) -> tuple[Frame, ...]:
        return await ending.dump_stacks(self._process)

    def trace(self) -> Trace:
        return self.trace_of(self._final_graph())

    def trace_of(self, graph: Graph) -> Trace:
        """A snapshot of all facts so far, with this graph."""
        return Trace(
            file=self._path.name,
            folder=str(self._path.parent),
            **self._source,
            parameters=self._given,
            started_at=self.started_at,
            samples={topic: tuple(samples) for topic, samples in self._observer.samples.items()},
            logs=tuple(self.logs),
            graph=graph,
            output=tuple(self.output),
            dropped_lines=self._process.dropped_lines,
            exit=self.exit,
            unbuilt=self._unbuilt,
        )

    @cached_property
    def _source(self) -> Mapping[str, Any]:
        return source.trace_fields(self._path)  # read once, at the first trace

    def _final_graph(self) -> Graph:
        """The current graph, or, once the process has ended, the last one seen."""
        return self._graph[1] if self.exit is not None else self.graph
