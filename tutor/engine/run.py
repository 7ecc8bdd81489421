"""One start of the learner's process, and what an observer on its domain sees of it."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

from tutor.engine.idle import Idle
from tutor.engine.source import launch_arguments, sources, uncalled_main, with_code
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
from tutor.process import CpuMeter, CpuTime, LearnerProcess, own_cpu_time
from tutor.process.cpu_wait import free_s
from tutor.ros import echo, graph, parameters
from tutor.ros.intake import MOST_SAMPLES
from tutor.ros.messages import to_plain
from tutor.ros.observer import ANY_PUBLISHER, AnswerTooLarge, Observer
from tutor.ros.talker import Talker
from tutor.ros_model import Graph, Parameter, echo_qos

T = TypeVar("T")

LOOK_EVERY_S = 0.05
"""How often a wait looks again where no fact comes in by itself: the graph has to be asked."""

MOST_EXTENSIONS = 5
"""A limit is extended by what the node was kept from running, up to this many times the limit."""

TOO_BUSY = "this machine is too busy: the node, or what watches it, did not get to run"

LITTLE_CPU_S = 0.5
"""A node that had less CPU time than this while it was waited for may not have been let run."""

ENOUGH_CPU_S = 2.0
"""No wait is for something that takes a node more CPU time than this: its start takes 0.3 s."""

IN_TRANSIT_S = 1.0
"""What a process has sent on its way before it ended may take this long to be gone."""

IN_FLIGHT_S = 0.5
"""What a process sent before it ended may arrive this much later."""

NEVER_S = 1e6
"""The limit of a request whose time is kept by `until`."""


class CollectedFacts:
    """What has been collected of one run, and a signal for each new fact."""

    def __init__(self) -> None:
        self.changed = asyncio.Event()
        self.served: list[ServedRequest] = []

    def change(self) -> None:
        """Wake everything that waits for a new fact."""
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
        self._asking = 0
        self.interrupted_at: float | None = None
        """When Ctrl+C was pressed, in seconds since the epoch."""

    @property
    def unanswered(self) -> bool:
        """Whether one of our requests waits for its answer."""
        return self._asking > 0

    @property
    def started_at(self) -> float:
        return self._process.started_at

    @property
    def logs(self) -> Sequence[LogRecord]:
        return self._observer.logs

    @property
    def graph(self) -> Graph:
        asked, seen = self._graph
        now = time.monotonic()
        if now - asked >= LOOK_EVERY_S:
            seen = graph.read_graph(self._observer.node)
            self._graph = (now, seen)
        return seen

    def peek_graph(self) -> Graph:
        """The graph now, for the words of the moment: no check ever hears of it, as the last that was seen."""
        asked, seen = self._graph
        if self.exit is not None or time.monotonic() - asked < LOOK_EVERY_S:
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
        # What was published before we came is got only from a publisher that keeps it.
        requested = offered if offered.durability == "transient_local" else ANY_PUBLISHER
        try:
            self._observer.watch(topic, type, requested)
        except UnknownType:
            return False
        return True

    def serve(self, service: str, type: str, handler: Handler) -> None:
        def served(request: Mapping[str, Any], response: Mapping[str, Any]) -> None:
            if len(self._facts.served) < MOST_SAMPLES:
                self._facts.served.append(ServedRequest(service, request, response, time.time()))
            self._facts.change()

        self._observer.serve(service, type, handler, served)

    def now(self) -> float:
        return time.time()

    def node_cpu_wait_s(self) -> float:
        return self._cpu().waited_s

    def our_cpu_wait_s(self) -> float:
        return own_cpu_time().waited_s

    def _cpu(self) -> CpuTime:
        if self.exit is not None:
            return CpuTime()
        asked, had = self._cpu_time
        now = time.monotonic()
        if now - asked >= LOOK_EVERY_S:
            had = self._meter.read()
            self._cpu_time = (now, had)
        return had

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        # The limit is for the node, not for a machine that does not let it run, or us see it.
        idle = Idle(self._process.next_wake, self.our_cpu_wait_s, idle_s) if idle_s is not None else None
        return await self._until(seen, limit_s, lambda: (self._cpu().waited_s, self.our_cpu_wait_s()), idle)

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

        # Its other threads are kept waiting by the machine while the main thread sleeps: no excuse for a late end. Nor
        # are we: what we see late has its time all the same.
        idle = Idle(self._process.next_wake, self.our_cpu_wait_s, RESENT_S)
        return await self._until(ended, limit_s, lambda: (self._cpu().main_waited_s,), idle, all_sent)

    async def _until(
        self,
        seen: Callable[[], bool],
        limit_s: float,
        waited_s: Callable[[], tuple[float, ...]],
        idle: Idle | None = None,
        all_sent: Callable[[], bool] = lambda: True,
    ) -> bool:
        """Wait as `until` does; the limit grows by what each of `waited_s` grows meanwhile, in seconds.

        That the process is idle counts from when `all_sent()`: there is nothing more from us to come.
        """
        loop = asyncio.get_running_loop()
        began, granted_s = loop.time(), 0.0
        deadline = began + limit_s
        ran_s, before_s = self._cpu().ran_s, waited_s()
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
            if idle is not None and all_sent() and idle.until(time.time() + deadline - now):
                return False
            if now >= deadline:
                if self._cpu().ran_s - ran_s >= ENOUGH_CPU_S:  # one that has used this much of the CPU has run
                    return False
                late_s = [after - before for after, before in zip(waited_s(), before_s, strict=True)]
                most_s = MOST_EXTENSIONS * limit_s
                owed_s = min(sum(late_s), most_s) - granted_s
                if owed_s < LOOK_EVERY_S:
                    # A shorter wait is a look, from which nothing follows; a node that has had CPU time was let run.
                    let_run = limit_s < 1.0 or self._cpu().ran_s - ran_s >= LITTLE_CPU_S
                    if not let_run and sum(late_s) > most_s and free_s(now - began, late_s) < limit_s:
                        raise MachineTooBusy(TOO_BUSY)
                    return False
                deadline, granted_s = deadline + owed_s, granted_s + owed_s
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._facts.changed.wait(), min(LOOK_EVERY_S, deadline - now))

    async def parameters(self, limit_s: float) -> tuple[Parameter, ...] | None:
        # Each for itself, that one which never answers does not hide the others; up to three requests, in turn.
        answers = await asyncio.gather(
            *(
                self._while_alive(parameters.get_parameters(self._observer, [node], NEVER_S), 2 * limit_s, None)
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
            parameters.set_parameters(self._observer, node, values, atomic=atomic, limit_s=NEVER_S),
            limit_s,
            None,
        )
        return answer or SetAnswer(values, False, False, "", asked, time.time())

    async def call(self, service: str, type: str, request: Mapping[str, Any], *, limit_s: float) -> CallAnswer:
        # A client that has just been made needs a moment to find the server: no part of what the service takes.
        asked = time.time()
        if matched := await self._while_alive(self._observer.wait_for_server(service, type, NEVER_S), limit_s, False):
            asked = time.time()
        response = None
        with contextlib.suppress(AnswerTooLarge):
            if matched:
                response = await self._while_alive(self._observer.call(service, type, request, NEVER_S), limit_s, None)
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
        echoing.add_done_callback(lambda _: self._facts.change())
        try:
            await self.until(echoing.done, limit_s, idle_s=RESENT_S)
            over.set()
            shown = await echoing
        finally:
            echoing.cancel()
        # echo asks a graph that has long settled; a newcomer may not have met every publisher yet.
        settled = {endpoint.type for endpoint in self.graph.publishers if endpoint.topic == topic}
        return replace(shown, types=tuple(sorted(settled.union(shown.types))))

    async def interrupt(self, limit_s: float = 5.0) -> Ending:
        pressed = time.time()
        self.interrupted_at = pressed
        self._process.interrupt()
        await self.wait_for_exit(limit_s)
        ended = self.exit
        took = (self.started_at + ended.after_s if ended is not None else time.time()) - pressed
        left = await self._left()
        return Ending(ended, took, limit_s, tuple(line for line in self.output if line.at >= pressed), left)

    async def _left(self) -> tuple[str, ...]:
        """What is still there. Once the first process has ended, those that are about to follow it are waited for."""
        deadline = time.monotonic() + (IN_TRANSIT_S if self.exit is not None else 0.0)
        while (left := await self._process.survivors()) and time.monotonic() < deadline:
            await asyncio.sleep(LOOK_EVERY_S)
        return tuple(survivor.command for survivor in left)

    async def command_lines(self) -> tuple[str, ...]:
        return tuple(survivor.command for survivor in await self._process.survivors())

    async def dump_stacks(self) -> tuple[Frame, ...]:
        if self.exit is not None:
            return ()
        asked = time.time()
        # PYTHONFAULTHANDLER (set by the bench) makes a fatal signal write all threads' stacks to stderr.
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._process.pid, signal.SIGABRT)
        await self._process.wait(2.0)
        frames = tracebacks.dumped_frames(line for line in self.output if line.at >= asked)
        return with_code(frames)

    def trace(self) -> Trace:
        return self.trace_of(self._final_graph())

    def trace_of(self, graph: Graph) -> Trace:
        """All facts so far, with this graph."""
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

    async def _while_alive(self, asking: Coroutine[Any, Any, T], limit_s: float, otherwise: T) -> T:
        """The answer, or `otherwise` where none comes within the limit, or before the process ends or falls idle."""
        task = asyncio.ensure_future(asking)
        task.add_done_callback(lambda _: self._facts.change())
        self._asking += 1
        try:
            # Whoever waits without a time-out does not answer, unless our message has yet to arrive.
            await self.until(task.done, limit_s, idle_s=RESENT_S)
            return task.result() if task.done() else otherwise
        finally:
            self._asking -= 1
            task.cancel()

    @cached_property
    def _source(self) -> dict[str, Any]:
        """What the file says about itself."""
        path = self._path
        return {
            "uncalled_main": uncalled_main(path),
            "launch_arguments": launch_arguments(path),
            "sources": sources(path),
        }

    def _final_graph(self) -> Graph:
        """The graph now, or, where the process has ended, the last that was seen of it."""
        return self._graph[1] if self.exit is not None else self.graph
