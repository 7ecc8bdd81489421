"""Judges the submission of one learner, within the time that the system gives an autograder."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from tutor import __version__, private_folders
from tutor.content import Course
from tutor.grade.autograder import Settings
from tutor.grade.capacity import checks_at_once
from tutor.grade.grading import Grading, LocalExecutor, Options
from tutor.grade.results import Result, ResultFolder, Version
from tutor.grade.unit import DEFAULT_LIMIT_S, OnEvent
from tutor.grade.work import Work, find_work
from tutor.judge.result import Environment, Report
from tutor.process.isolation_support import try_isolation
from tutor.stop_signals import run_until_stopped

_LEARNER = "submission"


def judge(submission: Path, settings: Settings, course: Course, lessons: Path | None) -> list[Result]:
    """Return a result for each exercise. `submission`: a folder. `lessons`: a course of the teacher's own.

    Raises TutorError and Stopped.
    """
    with private_folders.temporary("autograder") as scratch:
        works = _find(submission, scratch, settings, course)
        options = Options(_can_isolate(), min(DEFAULT_LIMIT_S, settings.time_limit_s), lessons)
        folder = ResultFolder(scratch / "results")
        grading = Grading(course, folder)
        run_until_stopped(lambda: _grade(grading, works, options, settings.time_limit_s))
        return [folder.read(work.learner, work.exercise) or _not_finished(work) for work in works]


def _find(submission: Path, scratch: Path, settings: Settings, course: Course) -> list[Work]:
    """Return the work on each exercise: a class of one learner, whose folder is the submission."""
    for name in ("class", "unpacked"):
        (scratch / name).mkdir()
    (scratch / "class" / _LEARNER).symlink_to(submission.absolute())
    return find_work(scratch / "class", course, scratch / "unpacked", exercises=settings.exercises, layout="{learner}")


def _can_isolate() -> bool:
    problem = try_isolation()
    if problem is not None:
        say(f"the submission is isolated by nothing but this machine ({problem})")
    return problem is None


async def _grade(grading: Grading, works: Sequence[Work], options: Options, limit_s: float) -> None:
    """Grade as much as there is time for."""
    try:
        async with asyncio.timeout(limit_s):
            await grading.grade(grading.plan(works), LocalExecutor(checks_at_once()), options, _Log())
    except TimeoutError:
        say(f"not everything could be judged within {limit_s:.0f} s")


def _not_finished(work: Work) -> Result:
    """Return the result of a check for which there was no time."""
    now = datetime.now(UTC).isoformat(timespec="seconds")
    report = Report(Environment("", "", "", __version__), (), 0.0, message="there was no time left to judge this")
    return Result(work.learner, work.exercise, now, work.digest, Version("", __version__), report)


class _Log:
    """Tells how grading goes. Nothing in it came from the submission: a runner may read commands in what is printed."""

    def started(self, work: Work) -> None:
        say(f"{work.exercise}: checking")

    def event(self, work: Work) -> OnEvent:
        return lambda event: None

    def finished(self, result: Result) -> None:
        say(f"{result.exercise}: {result.status}")


def say(text: str) -> None:
    """Print a message as one line on stderr."""
    print(f"ros-tutor: {' '.join(text.split())}", file=sys.stderr, flush=True)
