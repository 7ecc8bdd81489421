"""The engine as a separate process: `python -m tutor.engine EXERCISE PATH` prints events as JSON lines.

The terminal app runs checks this way, so that it never shares a process with ROS. With `--standby`, the engine prepares
itself, and then waits for its arguments: one line on stdin, a JSON list. It exits at the end of stdin.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import importlib
import json
import math
import os
import resource
import signal
import sys
import time
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

from tutor.content import load_course
from tutor.engine import run_check
from tutor.engine.isolation import Isolation
from tutor.engine.machine import Limits, Machine, prepare
from tutor.engine.scheduling import TURN_LIMIT_S
from tutor.errors import ContentError, EngineError, SubmissionError, UnknownExercise
from tutor.interpreter import reduce_gc_frequency
from tutor.judge.events import Event, ResourcesUsed, encode
from tutor.process.isolation_support import told
from tutor.process.prctl import adopt_orphans, die_with_parent
from tutor.stop_signals import Stopped, run_until_stopped
from tutor.workspace import find_submission

_REAP_LIMIT_S, _REAP_INTERVAL_S = 1.0, 0.002


def main() -> int:
    """Run one check.

    Exit code 0: judged, whatever the verdict, or no arguments on stdin; 2: wrong usage; 3: a fault; 130: interrupted.
    2 and 3 are explained on stderr.
    """
    reduce_gc_frequency()
    arguments = _parse(sys.argv[1:])
    die_with_parent(signal.SIGINT)  # a killed app takes its check with it; SIGINT ends the check cleanly
    try:
        if arguments.try_isolation:
            return _try_isolation()
        isolation = Isolation.set_up() if arguments.isolate else None  # while this process is still single-threaded
        run_until_stopped(_stand_by if arguments.standby else lambda: _check(arguments, isolation=isolation))
    except (ContentError, SubmissionError, UnknownExercise) as error:
        print(error, file=sys.stderr)
        return 2
    except EngineError as error:
        print(f"{error}. {error.hint}", file=sys.stderr)
        return 3
    except Stopped:
        return 130
    return 0


def _try_isolation() -> int:
    adopt_orphans(True)
    try:
        Isolation.set_up()
    except EngineError as error:
        print(told(error))
        return 3
    finally:
        _reap_orphans()
    return 0


def _parse(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tutor.engine")
    parser.add_argument("exercise", nargs="?")
    parser.add_argument("path", type=Path, nargs="?")
    parser.add_argument("--criterion", action="append")
    parser.add_argument("--first", action="store_true")
    parser.add_argument("--lessons", type=Path, action="append", default=[])
    parser.add_argument("--only", action="store_true", help="without the bundled course")
    parser.add_argument("--standby", action="store_true")
    parser.add_argument("--isolate", action="store_true")
    parser.add_argument("--try-isolation", action="store_true", help="do nothing else")
    parser.add_argument("--limit", type=float, metavar="SECONDS")
    parser.add_argument("--patient", action="store_true", help="wait for a turn for as long as it takes")
    parser.add_argument("--usage", action="store_true", help="report the resources used, as the last event")
    arguments = parser.parse_args(words)
    if not (arguments.standby or arguments.try_isolation) and arguments.path is None:
        parser.error("EXERCISE and PATH are missing")
    return arguments


async def _stand_by() -> None:
    async with prepare() as machine:
        importlib.import_module("tutor.mistakes")  # a check that is not on standby imports it when something fails
        if line := await _read_line():
            await _check(_parse(json.loads(line)), machine)


async def _read_line() -> str:
    """Return a line of stdin, or "" at its end. Unlike a read in a thread, this can be cancelled."""
    readable = asyncio.Event()
    loop = asyncio.get_running_loop()
    loop.add_reader(sys.stdin.fileno(), readable.set)
    try:
        await readable.wait()
    finally:
        loop.remove_reader(sys.stdin.fileno())
    return sys.stdin.readline()


async def _check(
    arguments: argparse.Namespace, machine: Machine | None = None, isolation: Isolation | None = None
) -> None:
    course = load_course(arguments.lessons, only=arguments.only)
    submission = find_submission(course.find(arguments.exercise), arguments.path, None)
    limits = Limits(arguments.limit, math.inf if arguments.patient else TURN_LIMIT_S)
    async with nullcontext(machine) if machine else prepare(isolation, [submission]) as ready:
        await run_check(
            [submission],
            course,
            only=frozenset(arguments.criterion) if arguments.criterion else None,
            first=arguments.first,
            on_event=_print_event,
            machine=replace(ready, limits=limits),
        )
    if machine is None:  # else the fork server is still running
        _reap_orphans()
    if arguments.usage:
        own, ended = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu_s = sum(usage.ru_utime + usage.ru_stime for usage in (own, ended))
        _print_event(ResourcesUsed(cpu_s))


def _reap_orphans() -> None:
    """Reap what became our children when its parents ended, such as bubblewrap's; its CPU time counts only then."""
    until = time.monotonic() + _REAP_LIMIT_S
    with contextlib.suppress(ChildProcessError):
        while time.monotonic() < until:
            if not os.waitpid(-1, os.WNOHANG)[0]:
                time.sleep(_REAP_INTERVAL_S)


def _print_event(event: Event) -> None:
    try:
        print(encode(event), flush=True)
    except BrokenPipeError:  # the reader is gone: only cleanup is left to do
        signal.raise_signal(signal.SIGINT)


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        sys.exit(main())
    sys.exit(130)
