"""Waits for facts about a running node, whose limits its own and our waits for a CPU extend.

A wait ends early once the process is idle: a node whose threads are all blocked, none of them with a timeout, sends
nothing more.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any, TypeVar

from tutor.errors import EngineError, MachineTooBusy
from tutor.judge.trace import Exit, ServedRequest
from tutor.judge.waiting_for_nodes import IDLE_S, RESENT_S
from tutor.process import CpuMeter, CpuTime, LearnerProcess, NextWake, count_dropped_datagrams, own_cpu_time
from tutor.process.cpu_wait import MAX_EXTENSION_FACTOR, estimate_unblocked_s

if TYPE_CHECKING:
    from tutor.ros.observer import Observer  # imports rclpy

T = TypeVar("T")

LOSSLESS_S = 1.0
"""Where no datagram was dropped, all that an idle process sent, or was sent, has arrived within this time."""

POLL_S = 0.05
"""Poll interval for what raises no events of its own, such as the graph; also the maximum age of cached readings."""

IDLE_POLL_S = 0.1
"""Minimum interval between two readings of the process's threads."""

TOO_BUSY = "this machine is too busy: the node, or the process that observes it, did not get to run"

LITTLE_CPU_S = 0.5
"""A node that got less CPU time than this during a wait may have been slowed too much to do anything."""

ENOUGH_CPU_S = 2.0
"""Nothing that is waited for takes a process more CPU time than this: a node's start, for example, takes 0.3 s."""

MAX_LATENCY_S = 0.5
"""Upper bound on the latency of a message that a process sent before it ended."""

DISCOVERY_S = 0.1
"""The same for a process that failed before anything of it was discovered, as with most exceptions at the start.

Discovery takes some milliseconds on one machine. Our own waits for a CPU extend this, up to `MAX_LATENCY_S`.
"""


class CollectedFacts:
    """The facts about one run that are kept here, and an event that is set for every new fact about it."""

    def __init__(self) -> None:
        self.changed = asyncio.Event()
        self.served: list[ServedRequest] = []

    def notify(self) -> None:
        """Wake up all waits for a new fact."""
        self.changed.set()


class Waits:
    """Waits for what a process does, on each change that is reported through `changed`."""

    def __init__(
        self, process: LearnerProcess, observer: Observer, changed: asyncio.Event, is_known: Callable[[], bool]
    ) -> None:
        """`is_known`: whether anything of the process has been discovered or received."""
        self._is_known = is_known
        self._process = process
        self._observer = observer
        self._changed = changed
        self._meter = CpuMeter(process.pid)
        self._cpu_time: tuple[float, CpuTime] = (0.0, CpuTime())
        self._pending_requests = 0
        self._dropped_before = count_dropped_datagrams()
        self._ended: tuple[float, float] | None = None
        """When a wait first saw that the process had ended, by the loop's clock, and our CPU wait by then.

        Messages in transit are waited for once, not again in each later wait.
        """

    @property
    def awaits_response(self) -> bool:
        """Whether one of our requests is waiting for its response."""
        return self._pending_requests > 0

    def cpu_time(self) -> CpuTime:
        """Return the process's CPU time, at most `POLL_S` old; once it has ended, the last one read."""
        read_at, cpu_time = self._cpu_time
        now = time.monotonic()
        if self._process.exit is None and now - read_at >= POLL_S:
            cpu_time = self._meter.read()
            self._cpu_time = (now, cpu_time)
        return cpu_time

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        """Wait as `tutor.judge.bench.Run.until` does."""
        # The limit is for the node: time in which the machine let neither it nor us run does not count.
        idle = self._idle_detector(idle_s) if idle_s is not None else None
        return await self._until(seen, limit_s, self._cpu_waits_s, idle)

    async def for_exit(
        self,
        limit_s: float,
        meanwhile: Callable[[], object],
        all_sent: Callable[[], bool],
        given_up: Callable[[], bool],
    ) -> bool:
        """Wait as `tutor.judge.bench.Run.wait_for_exit` does."""

        def ended() -> bool:
            meanwhile()
            return self._process.exit is not None or given_up()

        # Of the program's threads, only the main one's wait for a CPU extends the limit for its exit: others may wait
        # while it sleeps. A delay of ours changes nothing, since an exit that we see late still has its own time.
        idle = self._idle_detector(RESENT_S)
        await self._until(ended, limit_s, lambda: (self.cpu_time().main_waited_s,), idle, all_sent)
        return self._process.exit is not None

    async def for_response(
        self,
        request: Callable[[], Coroutine[Any, Any, T]],
        limit_s: float,
        default: T,
        *,
        resend_s: float = math.inf,
        all_sent: Callable[[], bool] = lambda: True,
    ) -> T:
        """Send a request, and await its response.

        Return `default` if none comes within the limit, or before the process exits or is idle. `resend_s`: the request
        is sent again after this many seconds without a response. `all_sent`: see `tutor.judge.bench.Run.call`.
        """
        task = asyncio.ensure_future(request())
        task.add_done_callback(lambda _: self._changed.set())
        self._pending_requests += 1
        try:
            # A process that is idle for longer than a lost request takes to be resent is not going to respond.
            idle = self._idle_detector(RESENT_S, LOSSLESS_S if resend_s == math.inf else resend_s + IDLE_S)
            await self._until(task.done, limit_s, self._cpu_waits_s, idle, all_sent)
            return task.result() if task.done() else default
        finally:
            self._pending_requests -= 1
            task.cancel()

    def _may_receive(self, ended: Exit, now: float) -> bool:
        """Whether messages of the process, which has ended, may still be in transit."""
        if self._ended is None:
            self._ended = (now, own_cpu_time().waited_s)
        ended_at, waited_s = self._ended
        if not ended.code or self._is_known():
            return now - ended_at < MAX_LATENCY_S
        return now - ended_at < min(DISCOVERY_S + own_cpu_time().waited_s - waited_s, MAX_LATENCY_S)

    def _cpu_waits_s(self) -> tuple[float, ...]:
        return self.cpu_time().waited_s, own_cpu_time().waited_s

    def _idle_detector(self, for_s: float, lossless_s: float = LOSSLESS_S) -> IdleDetector:
        return IdleDetector(
            self._process.next_wake,
            lambda: sum(self._cpu_waits_s()),
            for_s,
            lossless_s=lossless_s,
            may_have_lost=self._may_have_lost,
        )

    def _may_have_lost(self) -> bool:
        """Whether a datagram of the run may have been dropped, and so be sent again only after seconds."""
        dropped = count_dropped_datagrams()
        return dropped is None or dropped != self._dropped_before

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
        ran_before_s, waited_before_s = self.cpu_time().ran_s, waited_s()
        while True:
            self._changed.clear()
            if self._observer.fault is not None:
                raise EngineError(f"watching the node failed: {self._observer.fault}")
            if seen():
                return True
            now = loop.time()
            if (ended := self._process.exit) is not None and not self._may_receive(ended, now):
                return False
            if idle is not None and all_sent() and idle.is_idle_until(time.time() + deadline - now):
                return False
            if now >= deadline:
                enough_s = ENOUGH_CPU_S * self._meter.process_count
                if self.cpu_time().ran_s - ran_before_s >= enough_s:  # it was not slowed too much
                    return False
                cpu_waits_s = [after - before for after, before in zip(waited_s(), waited_before_s, strict=True)]
                max_extension_s = MAX_EXTENSION_FACTOR * limit_s
                extension_s = min(sum(cpu_waits_s), max_extension_s) - extended_by_s
                if extension_s < POLL_S:
                    # With a limit below 1 s, no verdict depends on the result; with enough CPU time, the node did run.
                    ran_enough = limit_s < 1.0 or self.cpu_time().ran_s - ran_before_s >= LITTLE_CPU_S
                    unblocked_s = estimate_unblocked_s(now - began, cpu_waits_s)
                    slowed_too_much = sum(cpu_waits_s) > max_extension_s and unblocked_s < limit_s
                    if not ran_enough and slowed_too_much:
                        raise MachineTooBusy(TOO_BUSY)
                    return False
                deadline, extended_by_s = deadline + extension_s, extended_by_s + extension_s
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._changed.wait(), min(POLL_S, deadline - now))


class IdleDetector:
    """Detects whether a process is idle.

    `next_wake(by)`: see `tutor.process.next_wake`. `for_s`: how long its threads must have been blocked, in seconds;
    `lossless_s`: the same if nothing can have been lost on its way, as `may_have_lost()` tells. `cpu_wait_s()`: how
    long we have waited for a CPU so far; within limits, that time does not count, since messages may have arrived that
    we have not seen.
    """

    def __init__(
        self,
        next_wake: Callable[[float], NextWake],
        cpu_wait_s: Callable[[], float],
        for_s: float,
        *,
        lossless_s: float,
        may_have_lost: Callable[[], bool],
    ) -> None:
        self._next_wake = next_wake
        self._cpu_wait_s = cpu_wait_s
        self._for_s = for_s
        self._lossless_s = min(for_s, lossless_s)
        self._may_have_lost = may_have_lost
        self._read_at = 0.0
        self._timeslices = -1
        self._idle_since = self._waited_before_s = 0.0
        self._idle = False

    def is_idle_until(self, deadline: float) -> bool:
        """Whether the process is idle and will stay so until `deadline` (seconds since the epoch). Must be polled."""
        now = time.monotonic()
        if now - self._read_at < IDLE_POLL_S:
            return self._idle
        self._read_at = now
        wake = self._next_wake(deadline)
        if wake.at <= deadline or wake.timeslices != self._timeslices:
            self._timeslices = wake.timeslices
            self._idle_since, self._waited_before_s = now, self._cpu_wait_s()
            self._idle = False
        else:
            idle_s = now - self._idle_since
            self._idle = idle_s >= self._extended(self._lossless_s) and (
                idle_s >= self._extended(self._for_s) or not self._may_have_lost()
            )
        return self._idle

    def _extended(self, for_s: float) -> float:
        return for_s + min(self._cpu_wait_s() - self._waited_before_s, MAX_EXTENSION_FACTOR * for_s)
