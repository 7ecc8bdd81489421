"""One check of one submission: a process of its own that prints events, here or on another machine."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tutor import interpreter, private_folders
from tutor.grade import private_paths
from tutor.grade.submission_files import unpack_packed
from tutor.judge.events import WAITING, CheckFinished, Event, Progress, ResourcesUsed
from tutor.judge.result import Report
from tutor.session.engine_process import EngineChild

DEFAULT_LIMIT_S = 300.0
"""The longest check of our test submissions took 167 s, on a machine with ten times as much to do as it could."""

_SILENCE_S = 120.0
"""How much longer than its limit a check may be silent before its process is taken for stuck, in seconds."""


@dataclass(frozen=True, slots=True)
class Unit:
    """A check that can be sent to another machine: the files of a submission (see `archives.pack`), and how to judge.

    `key` identifies it within a class, and appears in no process of the submission's. `main`: see `Work`. `lessons`: a
    folder with a course of the teacher's own, which each machine must have at this place.
    """

    key: str
    exercise: str
    packed: bytes
    main: str = "."
    isolate: bool = True
    limit_s: float = DEFAULT_LIMIT_S
    lessons: Path | None = None


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a unit. Without `report`, `fault` says in a line what kept the check from being carried out.

    `cpu_s`: the CPU time of all its processes, in seconds.
    """

    report: Report | None
    cpu_s: float = 0.0
    fault: str = ""


OnEvent = Callable[[Event], None]


async def run_unit(unit: Unit, on_event: OnEvent = lambda event: None) -> Outcome:
    """Run the check. No process of it is left when this returns or is cancelled.

    It waits for its turn among all checks of this machine for as long as it takes.
    """
    try:
        with private_folders.temporary("grade") as scratch:
            folder = scratch / "submission"
            folder.mkdir()
            await asyncio.to_thread(unpack_packed, unit.packed, folder)
            return await _run(unit, folder / unit.main, scratch, on_event)
    except OSError as error:
        return Outcome(None, fault=f"the submission cannot be copied: {error.strerror or error}")


async def _run(unit: Unit, path: Path, cwd: Path, on_event: OnEvent) -> Outcome:
    options = ["--limit", f"{unit.limit_s}", "--patient", "--usage"]
    options += ["--isolate"] if unit.isolate else []
    options += ["--lessons", str(unit.lessons)] if unit.lessons is not None else []
    argv = interpreter.module_command("tutor.engine", unit.exercise, str(path), *options)
    child = await EngineChild.start(argv, cwd)
    report: Report | None = None
    cpu_s = 0.0
    watch = _Watch(unit.limit_s + _SILENCE_S)
    try:
        async with asyncio.timeout(None) as timeout:
            watch.follow(timeout)
            async for event in child.events():
                watch.heard(event)
                if isinstance(event, CheckFinished):
                    report = event.report
                elif isinstance(event, ResourcesUsed):
                    cpu_s = event.cpu_s
                on_event(event)
            code = await child.ended()
    except TimeoutError:
        return Outcome(None, fault=f"the check was silent for {watch.limit_s:.0f} s")
    except ValueError as error:
        return Outcome(None, fault=f"the check's process printed what it should not: {error}")
    finally:
        await child.stop()
    if report is not None:
        return Outcome(private_paths.clean(report), cpu_s)
    tail = next((line for line in reversed(child.output_tail) if line.strip()), "")
    return Outcome(None, fault=tail or f"the check's process ended with exit code {code}")


class _Watch:
    """Ends the wait for a process that says nothing for too long, unless it is waiting for its turn."""

    def __init__(self, limit_s: float) -> None:
        self.limit_s = limit_s
        self._timeout: asyncio.Timeout | None = None

    def follow(self, timeout: asyncio.Timeout) -> None:
        self._timeout = timeout
        self._set(self.limit_s)

    def heard(self, event: Event) -> None:
        waiting = isinstance(event, Progress) and event.fraction == 0.0 and event.doing == WAITING
        self._set(math.inf if waiting else self.limit_s)

    def _set(self, limit_s: float) -> None:
        assert self._timeout is not None
        now = asyncio.get_running_loop().time()
        self._timeout.reschedule(None if math.isinf(limit_s) else now + limit_s)
