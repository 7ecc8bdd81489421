"""Check submissions in parallel, and report."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from pathlib import Path

from tutor.content import Course
from tutor.engine import turns
from tutor.engine.isolation import Isolation
from tutor.engine.package_folders import package_folder
from tutor.engine.preparation import Prepared, prepare
from tutor.engine.sandbox import Sandboxes
from tutor.engine.start_limiter import StartLimiter
from tutor.judge.check import Check
from tutor.judge.events import CheckFinished, Event
from tutor.judge.result import Report
from tutor.judge.submission import Submission


async def run_check(
    submissions: Sequence[Submission],
    course: Course,
    *,
    only: frozenset[str] | None = None,
    on_event: Callable[[Event], None] = lambda event: None,
    start_limiter: StartLimiter | None = None,
    isolation: Isolation | None = None,
    first: bool = False,
    prepared: Prepared | None = None,
    limit_s: float | None = None,
    turn_limit_s: float = turns.LIMIT_S,
) -> Report:
    """Judge the submissions in parallel. No process is left when this returns, is cancelled or raises.

    `only`: ids of the criteria to show (None: all). `start_limiter`: shared among checks that run concurrently.
    `isolation`: isolates all processes of the submissions. `first`: end each submission's check at the first required
    criterion that fails, and skip those not judged by then. `prepared`: by a `prepare` block around this call, without
    isolation; otherwise this process is prepared here, and its environment variables are restored afterwards.
    `limit_s`: what is not judged by then is an error. `turn_limit_s`: how long to wait for a turn at most.
    Raises EngineError if checks cannot run here.
    """
    from tutor.engine import unchanged
    from tutor.engine.modules import load_check

    shared_limiter = start_limiter or StartLimiter()
    sandboxes = Sandboxes(isolation, map(package_folder, _files_of(submissions))) if isolation else None
    async with nullcontext(prepared) if prepared else prepare(sandboxes=sandboxes) as ready:
        from tutor.engine.runner import Runner  # imports rclpy, whose environment is set by now

        unchanged.refuse_changed_modules()

        def make_runner(submission: Submission) -> Runner:
            lesson = course.find(submission.exercise)
            check: Check = load_check(lesson)
            return Runner(
                check,
                lesson,
                submission,
                ready.ros,
                only,
                on_event,
                shared_limiter,
                sandboxes,
                ready.fork_server,
                tools=ready.tools,
                first=first,
                limit_s=limit_s,
            )

        runners = [make_runner(submission) for submission in submissions]

        def announce_waiting() -> None:
            for runner in runners:
                runner.announce_waiting()

        # A caller that shares a limiter among checks decides itself how many run concurrently.
        turn_socket = isolation.turn_socket if isolation else None
        waits = turns.turn(turn_socket, turn_limit_s, announce_waiting) if start_limiter is None else nullcontext()
        async with waits:
            started = time.monotonic()
            tasks = [asyncio.ensure_future(runner.run()) for runner in runners]
            try:
                results = await asyncio.gather(*tasks)
            finally:
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)
    report = Report(
        environment=ready.ros.for_report(),
        exercises=tuple(results),
        duration_s=time.monotonic() - started,
        isolation=isolation.restrictions if isolation else (),
    )
    on_event(CheckFinished(report))
    return report


def _files_of(submissions: Sequence[Submission]) -> Iterator[Path]:
    return (path.resolve() for submission in submissions for path in submission.files.values())
