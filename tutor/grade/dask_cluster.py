"""A Dask cluster before its first check: connects to it, compares versions, and counts what it can do at once."""

from __future__ import annotations

import logging
import os
import signal
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import dask
from distributed import Client, LocalCluster

from tutor import __version__, private_folders
from tutor.errors import EngineError
from tutor.grade import dask_worker
from tutor.grade.dask_worker import Facts, Versions
from tutor.terminal_text import printable

RESOURCE = "check"
"""What a worker may declare to say how many checks it takes at once: `dask worker --resources check=2`."""

WAIT_FOR_WORKERS_S = 300.0
"""How long to wait for a worker if there is none, as while a batch system is starting them, in seconds."""

KILLED_WORKERS = 3
"""A check in which so many workers are lost is not tried again."""

_SETTINGS = {
    "distributed.nanny.pre-spawn-environ": {},  # or submissions would get variables that they have nowhere else
    "distributed.deploy.lost-worker-timeout": "10 minutes",  # a worker's restart takes longer than 15 s if we are busy
    "distributed.worker.profile.enabled": False,
}
_FIND_OUR_PACKAGES = """
import sys
from importlib.util import find_spec
spec = find_spec("ros_tutor")
sys.path[:0] = [] if spec is None else [each for each in spec.submodule_search_locations if each not in sys.path]
"""
"""What the scheduler and the workers run before they can import our packages, which a wheel puts on nobody's path."""

_LOGGERS = ("distributed", "distributed.client", "tornado", "tornado.application")
_MAX_NAMED = 5

Say = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Capacity:
    """What the workers can do together. `slots`: checks at once; `resources`: what a check takes of a worker.

    `not_isolated`: why one of them cannot isolate submissions; None if all can, or were not asked.
    """

    workers: frozenset[str]
    slots: int
    cores: float
    resources: Mapping[str, float] | None
    versions: Versions
    not_isolated: EngineError | None


@contextmanager
def connect(scheduler: str | None, workers: int) -> Iterator[Client]:
    """Connect to a scheduler; without one, start `workers` worker processes on this machine. Raises EngineError."""
    with ExitStack() as stack:
        for name in _LOGGERS:
            stack.enter_context(_silenced(logging.getLogger(name)))
        try:
            cluster = stack.enter_context(_local_cluster(workers)) if scheduler is None else None
            client = Client(cluster or scheduler, set_as_default=False)
        except (OSError, ValueError, TypeError, RuntimeError, ImportError) as error:
            if scheduler is None:
                raise EngineError(f"Dask's workers cannot be started here: {_line(error)}") from error
            what = f"cannot connect to Dask's scheduler at {scheduler}: {_line(error)}"
            raise EngineError(
                what, "start one with `dask scheduler`, and workers with `dask worker ADDRESS`"
            ) from error
        stack.callback(client.close)
        _find_our_packages(client)
        yield client


def _find_our_packages(client: Client) -> None:
    find = partial(exec, _FIND_OUR_PACKAGES)
    client.run_on_scheduler(find)
    try:
        client.register_worker_callbacks(setup=find)
    except OSError:  # a worker has just gone: it is registered for new ones, and the others may not have answered yet
        client.run(find, on_error="ignore")


@contextmanager
def _local_cluster(workers: int) -> Iterator[LocalCluster]:
    with (
        private_folders.temporary("dask") as folder,
        dask.config.set(_SETTINGS),
        _environment_kept(),
        _sigint_blocked() as unblock,
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            memory_limit=None,
            local_directory=str(folder),
            silence_logs=logging.CRITICAL,
            scheduler_kwargs={
                "allowed_failures": KILLED_WORKERS - 1,
                "dashboard": False,
                "dashboard_address": "127.0.0.1:0",  # its web server, which answers questions about its health
            },
            preload=[dask_worker.__name__],
        ) as cluster,
    ):
        unblock()
        yield cluster


@contextmanager
def _environment_kept() -> Iterator[None]:
    """Remove the variables that Dask sets for its workers."""
    before = {name: os.environ.get(name) for name in dask_worker.VARIABLES}
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


@contextmanager
def _sigint_blocked() -> Iterator[Callable[[], None]]:
    """Start threads and processes with SIGINT blocked until the yielded function is called: they inherit it."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})

    def unblock() -> None:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)

    try:
        yield unblock
    finally:
        unblock()


@contextmanager
def _silenced(logger: logging.Logger) -> Iterator[None]:
    """Keep Dask's own messages off the terminal: what matters in them, we say ourselves."""
    before = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(before)


def inspect(client: Client, lessons: Path | None, *, isolate: bool, say: Say) -> Capacity:
    """Ask each worker what it is, after waiting for the first. Raises EngineError for one that differs from us."""
    if not client.scheduler_info()["workers"]:
        say(f"no worker has joined {address_of(client)} yet; waiting for one for {WAIT_FOR_WORKERS_S:.0f} s")
        try:
            client.wait_for_workers(1, timeout=WAIT_FOR_WORKERS_S)
        except TimeoutError as error:
            raise no_workers(client) from error
    expected = dask_worker.versions(lessons)
    answers: Mapping[str, Facts | Exception] = client.run(dask_worker.describe, lessons, isolate, on_error="return")
    known: Mapping[str, Any] = client.scheduler_info()["workers"]  # without those that have left in the meantime
    answers = {address: answers[address] for address in known if address in answers}
    problems = [
        f"{address}: {problem}" for address, answer in answers.items() if (problem := _problem(answer, expected))
    ]
    if problems:
        raise _differing(problems, len(answers))
    facts = {address: answer for address, answer in answers.items() if not isinstance(answer, Exception)}
    slots, resources = _slots([known[address] for address in facts])
    if slots < 1:
        raise no_workers(client)
    return Capacity(frozenset(known), slots, _cores(list(facts.values())), resources, expected, _not_isolated(facts))


def _slots(workers: Sequence[Mapping[str, Any]]) -> tuple[int, Mapping[str, float] | None]:
    """Return how many checks workers take at once, and what a check takes of one."""
    declared = [worker["resources"][RESOURCE] for worker in workers if RESOURCE in worker["resources"]]
    if declared:
        return int(sum(declared)), {RESOURCE: 1}
    return sum(worker["nthreads"] for worker in workers), None


def address_of(client: Client) -> str:
    """Return the address of the scheduler that a client is connected to."""
    assert client.scheduler is not None
    return str(client.scheduler.address)


def no_workers(client: Client) -> EngineError:
    """Return the error for a cluster without workers."""
    address = address_of(client)
    return EngineError(f"{address} has no workers", f"start some with `dask worker {address}`, then this command again")


def _problem(answer: Facts | Exception, expected: Versions) -> str:
    if isinstance(answer, Exception):
        return f"it cannot check ({_line(answer)})"
    if answer["versions"] is None:
        return answer["problem"]
    return dask_worker.differences(expected, answer["versions"])


def _differing(problems: Sequence[str], workers: int) -> EngineError:
    named = printable("; ".join(problems[:_MAX_NAMED]))
    more = f"; and {len(problems) - _MAX_NAMED} more" if len(problems) > _MAX_NAMED else ""
    return EngineError(
        f"{len(problems)} of {workers} workers cannot check this class: {named}{more}",
        f"install ros-tutor[cluster] {__version__} there, with the same course, and start them again",
    )


def _cores(workers: Sequence[Facts]) -> float:
    """Return how many cores there are: workers on one machine share them, unless each has its own."""
    machines: dict[str, list[Facts]] = defaultdict(list)
    for worker in workers:
        machines[worker["host"]].append(worker)
    total = 0.0
    for here in machines.values():
        has_quota = any(worker["cores"] < len(worker["cpus"]) for worker in here)
        cpus = {cpu for worker in here for cpu in worker["cpus"]}
        total += max(worker["cores"] for worker in here) if has_quota else len(cpus)
    return total


def _not_isolated(facts: Mapping[str, Facts]) -> EngineError | None:
    for address, worker in facts.items():
        if worker["not_isolated"] is not None:
            what, hint = worker["not_isolated"]
            return EngineError(f"{what} (Dask's worker {address})", hint)
    return None


def _line(error: Exception) -> str:
    text = printable(" ".join(str(error).split())) or type(error).__name__
    return text if len(text) <= 200 else f"{text[:200]}..."
