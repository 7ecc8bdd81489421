"""Runs checks on the workers of a Dask cluster, on this machine or on many (`ros-tutor[cluster]`).

A check is a task of Dask's: the submission travels to the worker in it, and the report is its result, so workers share
no disk with us. They need ros-tutor of the same version, and `bwrap` for isolation.

    dask scheduler                                            # on one machine
    dask worker tcp://SCHEDULER:8786 --nworkers 4 --nthreads 1 # on each of the others: 4 checks at once
    ros-tutor grade CLASS --executor dask --scheduler tcp://SCHEDULER:8786

Whoever reaches a scheduler or worker can run any code there. With an address `tls://...`, Dask encrypts, and takes only
peers whose certificate your authority has signed. It finds the files in its own configuration (`~/.config/dask/*.yaml`
or the environment), which the scheduler and workers read as well:

    export DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION=True
    export DASK_DISTRIBUTED__COMM__TLS__CA_FILE=ca.pem
    export DASK_DISTRIBUTED__COMM__TLS__CLIENT__CERT=me.pem   # and ..._CLIENT__KEY, if the key is in a file of its own
    # where they run: the same for SCHEDULER and WORKER
"""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Callable, Coroutine, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

from distributed import Client, Future, KilledWorker

from tutor.errors import EngineError
from tutor.grade import dask_worker
from tutor.grade.dask_cluster import (
    KILLED_WORKERS,
    WAIT_FOR_WORKERS_S,
    Capacity,
    Say,
    address_of,
    connect,
    inspect,
    no_workers,
)
from tutor.grade.dask_worker import Versions
from tutor.grade.unit import OnEvent, Outcome, Unit
from tutor.judge.events import Progress
from tutor.session.engine_process import CLEAN_UP_S
from tutor.terminal_text import printable

CarryOut = Callable[[Unit, str, Versions], Coroutine[None, None, Outcome]]
"""What a worker does with a unit: see `dask_worker.check`."""

_LOST = "its worker is gone: it begins again on another"
_NO_WORKERS = "waiting: all workers are gone"


@dataclass(slots=True)
class _Check:
    """A check in the cluster. `decided` gets its outcome if that comes from us. `lost`: workers that it lost."""

    unit: Unit
    on_event: OnEvent
    decided: asyncio.Future[Outcome]
    lost: int = 0

    def tell(self, doing: str) -> None:
        self.on_event(Progress(self.unit.exercise, "", 0.0, doing))


class DaskExecutor:
    """Runs checks on a Dask cluster, as many at once as it has places when `open_executor` looks, or `slots`.

    Workers may come and go. All its methods but `run` and `close` are called in Dask's own thread.
    """

    def __init__(
        self, client: Client, capacity: Capacity, slots: int, say: Say, carry_out: CarryOut = dask_worker.check
    ) -> None:
        self._client = client
        self._capacity = capacity
        self._carry_out = carry_out
        self._slots = slots
        self._say = say
        self._loop: asyncio.AbstractEventLoop = client.loop.asyncio_loop  # type: ignore[union-attr]
        self._prefix = f"ros-tutor-{uuid.uuid4().hex}-"
        self._numbers = count()
        self._checks: dict[str, _Check] = {}
        self._workers = set(capacity.workers)
        self._giving_up: asyncio.TimerHandle | None = None
        self._gave_up = False
        client.subscribe_topic("all", self._heard)

    @property
    def slots(self) -> int:
        """How many checks run at once."""
        return self._slots

    @property
    def cores(self) -> float:
        """How many cores the workers have together."""
        return self._capacity.cores

    @property
    def not_isolated(self) -> EngineError | None:
        """Why submissions cannot be isolated on some worker, with what to do; None if they can."""
        return self._capacity.not_isolated

    async def run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        """Run a check somewhere in the cluster. Raises EngineError if the cluster is lost, or all its workers."""
        running = asyncio.run_coroutine_threadsafe(self._run(unit, on_event), self._loop)
        return await asyncio.wrap_future(running)

    def close(self) -> None:
        """End all checks that are still running on workers, and wait until no process of them is left there."""
        if self._client.status == "running":
            self._client.sync(self._end_checks)

    async def _end_checks(self) -> None:
        ending = asyncio.ensure_future(self._client.run(dask_worker.end_checks, self._prefix, on_error="ignore"))
        await asyncio.wait((ending,), timeout=CLEAN_UP_S + 5.0)
        ending.cancel()

    async def _run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        if self._gave_up:
            raise no_workers(self._client)
        key = f"{self._prefix}{next(self._numbers)}"  # says nothing of the learner: Dask shows and logs it
        check = _Check(unit, on_event, self._loop.create_future())
        future = self._client.submit(
            self._carry_out,
            unit,
            key,
            self._capacity.versions,
            key=key,
            pure=False,
            resources=self._capacity.resources,
        )
        self._checks[key] = check
        self._expect_workers()
        waiting = asyncio.ensure_future(self._outcome(future))
        try:
            await asyncio.wait((waiting, check.decided), return_when=asyncio.FIRST_COMPLETED)
            return check.decided.result() if check.decided.done() else waiting.result()
        finally:
            del self._checks[key]
            waiting.cancel()
            await future.cancel()

    async def _outcome(self, future: Future[Any]) -> Outcome:
        try:
            error = await future.exception()
            results = await self._client.gather([future], errors="skip") if future.status == "finished" else []
        except OSError as problem:
            raise self._disconnected() from problem
        for result in results:
            if isinstance(result, Outcome):
                return result
        if isinstance(error, KilledWorker):
            return _killed(error.allowed_failures + 1)
        if error is not None:
            text = printable(" ".join(f"{type(error).__name__}: {error}".split()))
            return Outcome(None, fault=f"Dask could not carry out the check: {text[:200]}")
        raise self._disconnected()

    def _disconnected(self) -> EngineError:
        what = f"the connection to Dask's scheduler at {address_of(self._client)} is lost"
        return EngineError(what, "what was judged is kept: the same command goes on from there")

    # --- workers come and go ---

    def _heard(self, event: tuple[float, Mapping[str, Any]]) -> None:
        """Take note of an event of the scheduler's about its workers."""
        _, message = event
        if message.get("action") == "add-worker":
            self._joined(message["worker"])
        elif message.get("action") == "remove-worker":
            lost = [] if message["expected"] else [key for key in message["processing-tasks"] if key in self._checks]
            self._left(message["worker"], [self._checks[key] for key in lost])

    def _joined(self, worker: str) -> None:
        self._workers.add(worker)
        self._gave_up = False
        if self._giving_up is not None:
            self._giving_up.cancel()
            self._giving_up = None
            self._say(f"a worker has joined: {worker}")

    def _left(self, worker: str, checks: list[_Check]) -> None:
        self._workers.discard(worker)
        if checks:
            others = "1 check begins again on another"
            if len(checks) > 1:
                others = f"{len(checks)} checks begin again on others"
            self._say(f"worker {worker} is gone: {others}")
        for check in checks:
            check.lost += 1
            check.tell(_LOST)
            if check.lost >= KILLED_WORKERS and not check.decided.done():
                check.decided.set_result(_killed(check.lost))
        self._expect_workers()

    def _expect_workers(self) -> None:
        """If checks wait, and no worker is left, say so, and do not wait for ever."""
        if self._workers or not self._checks:
            return
        for check in self._checks.values():
            check.tell(_NO_WORKERS)
        if self._giving_up is None:
            self._say(f"no worker is left; waiting for one for {WAIT_FOR_WORKERS_S:.0f} s")
            self._giving_up = self._loop.call_later(WAIT_FOR_WORKERS_S, self._give_up)

    def _give_up(self) -> None:
        self._gave_up = True
        for check in self._checks.values():
            if not check.decided.done():
                check.decided.set_exception(no_workers(self._client))


def _killed(workers: int) -> Outcome:
    return Outcome(None, fault=f"{workers} workers died while they ran this check")


@contextmanager
def open_executor(
    scheduler: str | None,
    jobs: int | None,
    local_workers: int,
    lessons: Path | None,
    *,
    isolate: bool,
    live: bool,
    say: Say,
) -> Iterator[DaskExecutor]:
    """Connect to a scheduler, or start `local_workers` here, and close everything at the end. Raises EngineError.

    `jobs`: how many checks to have in the cluster at once, instead of as many as it has places. `isolate`: whether
    workers are asked if they can. `live`: a display shows how checks go, so that `say` is used only before the first.
    """
    with connect(scheduler, jobs or local_workers) as client:
        capacity = inspect(client, lessons, isolate=isolate, say=say)
        executor = DaskExecutor(client, capacity, jobs or capacity.slots, (lambda line: None) if live else say)
        try:
            yield executor
        finally:
            executor.close()
