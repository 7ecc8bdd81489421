"""Check submissions in parallel, and report."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractAsyncContextManager, nullcontext

from tutor.content import Course
from tutor.engine.isolation import Isolation
from tutor.engine.machine import Machine, prepare
from tutor.engine.scheduling import turn
from tutor.judge.events import CheckFinished, Event
from tutor.judge.result import Report
from tutor.judge.submission import Submission


async def run_check(
    submissions: Sequence[Submission],
    course: Course,
    *,
    only: frozenset[str] | None = None,
    first: bool = False,
    on_event: Callable[[Event], None] = lambda event: None,
    isolation: Isolation | None = None,
    machine: Machine | None = None,
) -> Report:
    """Judge the submissions in parallel. No process is left when this returns, is cancelled or raises.

    `only`: ids of the criteria to show (None: all). `first`: end each submission's check at the first required
    criterion that fails, and skip those not judged by then. `machine`: by a `prepare` block around this call; otherwise
    this process is prepared here, and its environment variables are restored afterwards. `isolation`: what isolates all
    processes of the submissions then. Raises EngineError if checks cannot run here.
    """
    from tutor.engine import loading

    async with nullcontext(machine) if machine else prepare(isolation, submissions) as ready:
        from tutor.engine.runner import Runner  # imports rclpy, whose environment is set by now

        loading.refuse_changed_modules()

        def make_runner(submission: Submission) -> Runner:
            lesson = course.find(submission.exercise)
            return Runner(ready, loading.load_check(lesson), lesson, submission, only, on_event, first=first)

        runners = [make_runner(submission) for submission in submissions]

        def announce_waiting() -> None:
            for runner in runners:
                runner.announce_waiting()

        async with _turn(ready, announce_waiting):
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
        isolation=ready.isolation.restrictions if ready.isolation else (),
    )
    on_event(CheckFinished(report))
    return report


def _turn(machine: Machine, on_wait: Callable[[], None]) -> AbstractAsyncContextManager[None]:
    if machine.limits.turn_s is None:
        return nullcontext()
    return turn(machine.isolation.turn_socket if machine.isolation else None, machine.limits.turn_s, on_wait)
