"""What runs on the workers of a Dask cluster: checks, and the questions asked before the first one."""

from __future__ import annotations

import asyncio
import os
import platform
import signal
import socket
from pathlib import Path
from typing import TypedDict

from distributed import Worker, get_worker

from tutor import __version__
from tutor.content import load_course
from tutor.errors import TutorError
from tutor.grade.capacity import cores
from tutor.grade.grading import course_digest
from tutor.grade.unit import Outcome, Unit, run_unit
from tutor.process.isolation_support import try_isolation

VARIABLES = ("PYTHONHASHSEED", "__DASK_PARENT_PID")
"""What Dask sets in the environment of its workers, and submissions would inherit, as nowhere else."""

_POLL_S = 0.5

_running: dict[str, asyncio.Task[Outcome]] = {}
"""The checks of this process, by their key in Dask."""


class Versions(TypedDict):
    """What has to be the same everywhere. `lessons`: the digest of each lesson and its check, by exercise."""

    ros_tutor: str
    python: str
    lessons: dict[str, str]


class Facts(TypedDict):
    """What a worker says of itself, as plain data: another version may be asked, or may answer.

    `cpus`: the CPUs it may use; `cores`: how many, a quota included. `problem`: why it has no course, in a line.
    `not_isolated`: why it cannot isolate submissions, and what to do; None if it can, or was not asked.
    """

    versions: Versions | None
    problem: str
    host: str
    cpus: list[int]
    cores: float
    not_isolated: tuple[str, str] | None


def versions(lessons: Path | None) -> Versions:
    """Return the versions here, with the course in `lessons`, or else ours. Raises TutorError and OSError."""
    return Versions(
        ros_tutor=__version__,
        python=".".join(platform.python_version_tuple()[:2]),
        lessons={lesson.id: course_digest(lesson) for lesson in load_course(lessons).lessons},
    )


def differences(expected: Versions, found: Versions) -> str:
    """Return in what `found` differs, in a line; "" if it does not."""
    parts = []
    if found["ros_tutor"] != expected["ros_tutor"]:
        parts.append(f"ros-tutor {found['ros_tutor']} instead of {expected['ros_tutor']}")
    if found["python"] != expected["python"]:
        parts.append(f"Python {found['python']} instead of {expected['python']}")
    here, there = expected["lessons"], found["lessons"]
    if exercises := [exercise for exercise in sorted({*here, *there}) if here.get(exercise) != there.get(exercise)]:
        parts.append(f"another lesson or check for {', '.join(exercises)}")
    return ", ".join(parts)


async def describe(lessons: Path | None, isolate: bool) -> Facts:
    """Return what there is to know of this worker. `isolate`: try whether it can isolate submissions."""
    problem = await asyncio.to_thread(try_isolation) if isolate else None
    facts = Facts(
        versions=None,
        problem="",
        host=socket.gethostname(),
        cpus=sorted(os.sched_getaffinity(0)),
        cores=cores(),
        not_isolated=None if problem is None else (str(problem), problem.hint),
    )
    try:
        facts["versions"] = await asyncio.to_thread(versions, lessons)
    except (TutorError, OSError) as error:
        facts["problem"] = str(error)
    return facts


async def check(unit: Unit, key: str, expected: Versions) -> Outcome:
    """Run a check on this worker. It ends when nobody waits for it any more, or the worker is closed.

    It runs in the worker's event loop, in the thread that lives as long as the worker does: the kernel ends the process
    of a check with the thread that has started it.
    """
    worker = get_worker()
    try:
        differing = differences(expected, await asyncio.to_thread(versions, unit.lessons))
    except (TutorError, OSError) as error:
        differing = str(error)
    if differing:
        return Outcome(None, fault=f"Dask's worker {worker.address}: {differing}")
    for name in VARIABLES:
        os.environ.pop(name, None)
    task = asyncio.ensure_future(run_unit(unit))
    _running[key] = task
    try:
        while not (await asyncio.wait((task,), timeout=_POLL_S))[0]:
            if not _is_wanted(worker, key):
                task.cancel()
        return Outcome(None, fault="it was cancelled") if task.cancelled() else task.result()
    finally:
        await _end((task,))
        del _running[key]


async def end_checks(prefix: str) -> None:
    """End the checks whose keys begin like this, and wait until no process of them is left."""
    await _end([task for key, task in _running.items() if key.startswith(prefix)])


async def _end(tasks: list[asyncio.Task[Outcome]] | tuple[asyncio.Task[Outcome], ...]) -> None:
    for task in tasks:
        task.cancel()
    if tasks:
        await asyncio.wait(tasks)


def _is_wanted(worker: Worker, key: str) -> bool:
    """Whether somebody waits for this result: Dask lets the task of a client that was cancelled or killed go on."""
    task = worker.state.tasks.get(key)
    return task is not None and task.state != "cancelled"


def dask_setup(worker: Worker) -> None:
    """Put a worker of a cluster on this machine out of reach of Ctrl+C in the terminal, which Dask does not survive.

    Dask calls this by its name. The worker was started with SIGINT blocked (see `dask_cluster`); checks need it.
    """
    os.setpgid(0, 0)
    while signal.sigtimedwait({signal.SIGINT}, 0) is not None:
        pass
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
