"""One run of the learner's process, with everything that an observer on its domain sees of it."""

from __future__ import annotations

import asyncio
import contextlib
import math
import os
import signal
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

from tutor.engine.idle import IdleDetector
from tutor.engine.source import add_source_lines, launch_arguments, read_sources, uncalled_main
from tutor.errors import EngineError, MachineTooBusy, UnknownType
from tutor.judge import tracebacks
from tutor.judge.bench import Handler
from tutor.judge.exceptions import KnownException
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
from tutor.judge.waiting import RESENT_S
from tutor.process import CpuMeter, CpuTime, LearnerProcess, next_wake, own_cpu_time
from tutor.process.cpu_wait import estimate_unblocked_s
from tutor.ros import echo, graph, parameters
from tutor.ros.intake import MAX_SAMPLES
from tutor.ros.messages import to_plain
from tutor.ros.observer import ANY_PUBLISHER, AnswerTooLarge, Observer
from tutor.ros.talker import Talker
from tutor.ros_model import Graph, Parameter, echo_qos

T = TypeVar("T")

ROS_ARGUMENTS = "--ros-args"
"""The launch system passes this to every node, whether it has any such arguments or not."""

POLL_S = 0.05
"""Poll interval for what raises no events of its own, such as the graph; also the maximum age of cached readings."""

MAX_EXTENSION_FACTOR = 5
"""A limit is extended by the node's and our own waits for a CPU, by at most this many times the limit."""

TOO_BUSY = "this machine is too busy: the node, or the process that observes it, did not get to run"

LITTLE_CPU_S = 0.5
"""A node that got less CPU time than this during a wait may have been starved by the machine."""

ENOUGH_CPU_S = 2.0
"""Nothing that is waited for takes a node more CPU time than this: its start, for example, takes 0.3 s."""

BLOCKED_S = 0.5
"""Maximum delay of Ctrl+C until the node has finished what it is doing; one that is always busy never has."""

BLOCKED_POLL_S = 0.01

CHILD_EXIT_S = 1.0
"""Grace period for child processes that are about to exit after the first process has."""

IN_FLIGHT_S = 0.5
"""Upper bound on the latency of a message that a process sent before it ended."""

NO_TIMEOUT_S = 1e6
"""Timeout of a request whose time limit `until` enforces."""


class CollectedFacts:
    """The facts about one run that are kept here, and an event that is set for every new fact about it."""

    def __init__(self) -> None:
        self.changed = asyncio.Event()
        self.served: list[ServedRequest] = []

    def notify(self) -> None:
        """Wake up all waits for a new fact."""
        self.changed.set()


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
        exceptions: tuple[KnownException, ...] = (),
    ) -> None:
        self._exceptions = exceptions
        self._path = path
        self._given = dict(given)
        self._domain_id = domain_id
        self._process = process
        self._observer = observer
        self._facts = facts
        self._graph: tuple[float, Graph] = (0.0, Graph())
        self._meter = CpuMeter(process.pid)
        self._cpu_time: tuple[float, CpuTime] = (0.0, CpuTime())
        self._pending_requests = 0
        self.interrupted_at: float | None = None
        """When Ctrl+C was pressed, in seconds since the epoch."""

    @property
    def awaits_response(self) -> bool:
        """Whether one of our requests is waiting for its response."""
        return self._pending_requests > 0

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
        offered = echo_qos(each.qos for each in self.graph.publishers if each.topic == topic)
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
        return self._read_cpu_time().waited_s

    def our_cpu_wait_s(self) -> float:
        return own_cpu_time().waited_s

    def _read_cpu_time(self) -> CpuTime:
        read_at, cpu_time = self._cpu_time
        now = time.monotonic()
        if self.exit is None and now - read_at >= POLL_S:
            cpu_time = self._meter.read()
            self._cpu_time = (now, cpu_time)
        return cpu_time

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        # The limit is for the node: time in which the machine let neither it nor us run does not count.
        idle = IdleDetector(self._process.next_wake, self.our_cpu_wait_s, idle_s) if idle_s is not None else None
        return await self._until(seen, limit_s, lambda: (self._read_cpu_time().waited_s, self.our_cpu_wait_s()), idle)

    async def wait_for_exit(
        self,
        limit_s: float,
        *,
        meanwhile: Callable[[], object] = lambda: None,
        all_sent: Callable[[], bool] = lambda: False,
    ) -> bool:
        def ended() -> bool:
            meanwhile()
            return self.exit is not None

        # Only the main thread's wait for a CPU excuses a late exit. Other threads may wait while it sleeps, and a delay
        # of ours changes nothing, since an exit that we see late still has its own time.
        idle = IdleDetector(self._process.next_wake, self.our_cpu_wait_s, RESENT_S)
        return await self._until(ended, limit_s, lambda: (self._read_cpu_time().main_waited_s,), idle, all_sent)

    async def _until(
        self,
        seen: Callable[[], bool],
        limit_s: float,
        waited_s: Callable[[], tuple[float, ...]],
        idle: IdleDetector | None = None,
        all_sent: Callable[[], bool] = lambda: True,
    ) -> bool:
        """Wait as `until` does; the growth of each of `waited_s` during the wait, in seconds, extends the limit.

        Idleness counts only once `all_sent()`, that is, when nothing more is to come from us.
        """
        loop = asyncio.get_running_loop()
        began, extended_by_s = loop.time(), 0.0
        deadline = began + limit_s
        ran_before_s, waited_before_s = self._read_cpu_time().ran_s, waited_s()
        ended_at: float | None = None
        while True:
            self._facts.changed.clear()
            if self._observer.fault is not None:
                raise EngineError(f"watching the node failed: {self._observer.fault}")
            if seen():
                return True
            now = loop.time()
            if self.exit is not None and ended_at is None:
                ended_at = now
            if ended_at is not None and now - ended_at >= IN_FLIGHT_S:
                return False
            if idle is not None and all_sent() and idle.is_idle_until(time.time() + deadline - now):
                return False
            if now >= deadline:
                if self._read_cpu_time().ran_s - ran_before_s >= ENOUGH_CPU_S:  # it was not starved
                    return False
                cpu_waits_s = [after - before for after, before in zip(waited_s(), waited_before_s, strict=True)]
                max_extension_s = MAX_EXTENSION_FACTOR * limit_s
                extension_s = min(sum(cpu_waits_s), max_extension_s) - extended_by_s
                if extension_s < POLL_S:
                    # With a limit below 1 s, no verdict depends on the result; with enough CPU time, the node did run.
                    ran_enough = limit_s < 1.0 or self._read_cpu_time().ran_s - ran_before_s >= LITTLE_CPU_S
                    unblocked_s = estimate_unblocked_s(now - began, cpu_waits_s)
                    starved = sum(cpu_waits_s) > max_extension_s and unblocked_s < limit_s
                    if not ran_enough and starved:
                        raise MachineTooBusy(TOO_BUSY)
                    return False
                deadline, extended_by_s = deadline + extension_s, extended_by_s + extension_s
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._facts.changed.wait(), min(POLL_S, deadline - now))

    async def parameters(self, limit_s: float) -> tuple[Parameter, ...] | None:
        # One task per node, so that one that never answers does not hide the others. Each makes up to three requests.
        answers = await asyncio.gather(
            *(
                self._while_alive(parameters.get_parameters(self._observer, [node], NO_TIMEOUT_S), 2 * limit_s, None)
                for node in self.graph.parameter_nodes
            )
        )
        answered = [answer for answer in answers if answer is not None]
        return tuple(parameter for answer in answered for parameter in answer) if answered else None

    async def set_parameters(
        self, node: str, values: Mapping[str, Any], *, atomic: bool = False, limit_s: float = 5.0
    ) -> SetAnswer:
        asked = time.time()
        answer = await self._while_alive(
            parameters.set_parameters(self._observer, node, values, atomic=atomic, limit_s=NO_TIMEOUT_S),
            limit_s,
            None,
        )
        return answer or SetAnswer(values, False, False, "", asked, time.time())

    async def call(
        self, service: str, type: str, request: Mapping[str, Any], *, limit_s: float, resend_s: float = math.inf
    ) -> CallAnswer:
        # A new client needs a moment to discover the server, which is no part of the service's response time.
        asked = time.time()
        if matched := await self._while_alive(
            self._observer.wait_for_server(service, type, NO_TIMEOUT_S), limit_s, False
        ):
            asked = time.time()
        response = None
        with contextlib.suppress(AnswerTooLarge):
            if matched:
                response = await self._while_alive(
                    self._observer.call(service, type, request, NO_TIMEOUT_S, resend_s=resend_s), limit_s, None
                )
        return CallAnswer(
            service=service,
            request=dict(request),
            response=None if response is None else to_plain(response),
            asked_at=asked,
            answered_at=time.time(),
        )

    @asynccontextmanager
    async def publisher(self, topic: str, type: str) -> AsyncIterator[Talker]:
        talker = Talker(self._domain_id, topic, type)
        try:
            yield talker
        finally:
            talker.close()

    async def echo(self, topic: str, *, samples: int, limit_s: float) -> Echo:
        over = asyncio.Event()
        echoing = asyncio.ensure_future(
            echo.echo_topic(self._domain_id, topic, samples=samples, limit_s=limit_s, over=over)
        )
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

    async def interrupt(self, limit_s: float = 5.0) -> Ending:
        await self._wait_until_blocked()
        pressed = time.time()
        cpu_wait_share = self._read_cpu_time().waited_s / max(pressed - self.started_at, POLL_S)
        self.interrupted_at = pressed
        self._process.interrupt()
        await self.wait_for_exit(limit_s)
        ended = self.exit
        took = (self.started_at + ended.after_s if ended is not None else time.time()) - pressed
        survivors = await self._survivors()
        output = tuple(line for line in self.output if line.at >= pressed)
        return Ending(ended, took, limit_s, output, survivors, cpu_wait_share)

    async def _wait_until_blocked(self) -> None:
        """Wait until all threads of the process are blocked, as they usually are when someone presses Ctrl+C.

        A node that is still handling our last request may end in another way than one that waits.
        """
        deadline = time.monotonic() + BLOCKED_S
        while self.exit is None and self._process.next_wake().at == 0.0 and time.monotonic() < deadline:
            await asyncio.sleep(BLOCKED_POLL_S)

    async def _survivors(self) -> tuple[str, ...]:
        """The command lines of surviving processes, after a grace period if the first process has ended."""
        deadline = time.monotonic() + (CHILD_EXIT_S if self.exit is not None else 0.0)
        while (left := self._process.survivors()) and time.monotonic() < deadline:
            await asyncio.sleep(POLL_S)
        return tuple(survivor.command for survivor in left)

    def command_lines(self) -> tuple[str, ...]:
        return tuple(survivor.command for survivor in self._process.survivors())

    def has_launched_all(self) -> bool:
        if next_wake([self._process.pid]).at != math.inf:  # first, as it does not read the whole process table
            return False
        children = [each.command for each in self._process.survivors() if each.pid != self._process.pid]
        return len(children) <= len(self.graph.nodes) and all(ROS_ARGUMENTS in each.split() for each in children)

    async def dump_stacks(self) -> tuple[Frame, ...]:
        if self.exit is not None:
            return ()
        aborted_at = time.time()
        # PYTHONFAULTHANDLER (set by the bench) makes a fatal signal write all threads' stacks to stderr.
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._process.pid, signal.SIGABRT)
        await self._process.wait(2.0)
        frames = tracebacks.dumped_frames(line for line in self.output if line.at >= aborted_at)
        return add_source_lines(frames)

    def trace(self) -> Trace:
        return self.trace_of(self._final_graph())

    def trace_of(self, graph: Graph) -> Trace:
        """A snapshot of all facts so far, with this graph."""
        return Trace(
            file=self._path.name,
            folder=str(self._path.parent),
            **self._source,
            exceptions=self._exceptions,
            parameters=self._given,
            started_at=self.started_at,
            samples={topic: tuple(samples) for topic, samples in self._observer.samples.items()},
            logs=tuple(self.logs),
            graph=graph,
            output=tuple(self.output),
            dropped_lines=self._process.dropped_lines,
            exit=self.exit,
        )

    async def _while_alive(self, request: Coroutine[Any, Any, T], limit_s: float, default: T) -> T:
        """Await a response; return `default` if none comes within the limit, or before the process exits or is idle."""
        task = asyncio.ensure_future(request)
        task.add_done_callback(lambda _: self._facts.notify())
        self._pending_requests += 1
        try:
            # A process that is idle for longer than a lost request takes to be resent is not going to respond.
            await self.until(task.done, limit_s, idle_s=RESENT_S)
            return task.result() if task.done() else default
        finally:
            self._pending_requests -= 1
            task.cancel()

    @cached_property
    def _source(self) -> dict[str, Any]:
        """What the file's source says; read once, at the first trace."""
        path = self._path
        return {
            "uncalled_main": uncalled_main(path),
            "launch_arguments": launch_arguments(path),
            "sources": read_sources(path),
        }

    def _final_graph(self) -> Graph:
        """The current graph, or, once the process has ended, the last one seen."""
        return self._graph[1] if self.exit is not None else self.graph
