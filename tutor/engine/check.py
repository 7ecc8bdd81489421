"""Check submissions, all at once, and report."""

from __future__ import annotations

import asyncio
import importlib
import resource
import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext, suppress

from tutor import __version__
from tutor.content import Course
from tutor.engine import turns
from tutor.engine.isolation import Isolation
from tutor.engine.start_limiter import StartLimiter
from tutor.errors import EngineError
from tutor.judge.check import Check
from tutor.judge.events import CheckFinished, Event
from tutor.judge.result import Environment, Report
from tutor.judge.submission import Submission

LEAST_DESCRIPTORS, ENOUGH_DESCRIPTORS = 512, 4096
"""A check of all exercises has some 350 files and sockets open. With fewer allowed, Fast DDS goes on without some."""

_INTERFACES = (
    "std_msgs",
    "rcl_interfaces",
    "builtin_interfaces",
    "service_msgs",
    "type_description_interfaces",
    "example_interfaces",
)
_LATE = (
    "rclpy.serialization",
    "rosidl_generator_py",
    *(f"{package}.{kind}" for package in _INTERFACES for kind in ("msg", "srv")),
    *(f"{package}.{package}_s__rosidl_typesupport_c" for package in _INTERFACES),
)
"""What would else be imported with the first message: a module whose file changes during a check is refused, even if
only uv has linked another environment to it."""


async def run_check(
    submissions: Sequence[Submission],
    course: Course,
    *,
    only: frozenset[str] | None = None,
    on_event: Callable[[Event], None] = lambda event: None,
    start_limiter: StartLimiter | None = None,
    isolation: Isolation | None = None,
    first: bool = False,
) -> Report:
    """Judge each submission, in parallel; nothing that was started is left when this returns, is cancelled or raises.

    `only`: the ids of the criteria to show (None: all). `start_limiter`: shared among checks that run at once.
    `isolation`: isolates all that is started of the submissions. `first`: each submission's check ends at the first
    required criterion that fails; those not judged by then are skipped. The environment of this process is the user's
    again afterwards. Raises EngineError where checks cannot be run here.
    """
    from tutor.ros import process_setup

    with process_setup.environment_restored():
        return await _run_check(
            submissions,
            course,
            only=only,
            on_event=on_event,
            start_limiter=start_limiter,
            isolation=isolation,
            first=first,
        )


async def _run_check(
    submissions: Sequence[Submission],
    course: Course,
    *,
    only: frozenset[str] | None,
    on_event: Callable[[Event], None],
    start_limiter: StartLimiter | None,
    isolation: Isolation | None,
    first: bool,
) -> Report:
    from tutor.engine import unchanged
    from tutor.engine.modules import load_check
    from tutor.ros import bytecode, process_setup
    from tutor.ros.discovery import require_loopback
    from tutor.ros.environment import detect

    together = start_limiter or StartLimiter()
    try:
        require_loopback()
    except OSError as error:
        what = f"nothing can be sent to 127.0.0.1 ({error}), and nodes talk over it"
        raise EngineError(what, "switch the loopback interface on: sudo ip link set lo up") from error
    _require_descriptors()
    ros = detect()
    try:
        process_setup.prepare_for_rclpy(ros, isolated=True)
        process_setup.keep_stdout()
        await asyncio.to_thread(bytecode.compile_ros_modules, ros)
        from tutor.engine.runner import Runner  # brings in rclpy, which must find its environment chosen
    except (ImportError, OSError, RuntimeError) as error:
        raise EngineError(f"ROS 2 cannot be used here: {error}") from error

    for name in _LATE:
        with suppress(ImportError):
            importlib.import_module(name)
    unchanged.refuse_changed_modules()

    def runner_of(submission: Submission) -> Runner:
        lesson = course.find(submission.exercise)
        found: Check = load_check(lesson)
        return Runner(found, lesson, submission, ros, only, on_event, together, isolation, first=first)

    runners = [runner_of(submission) for submission in submissions]

    def tell_waiting() -> None:
        for runner in runners:
            runner.wait_for_turn()

    # A caller that shares a limiter among checks decides how many run at once.
    own = isolation.turn_socket if isolation else None
    async with turns.turn(own, on_wait=tell_waiting) if start_limiter is None else nullcontext():
        started = time.monotonic()
        tasks = [asyncio.ensure_future(runner.run()) for runner in runners]
        try:
            results = await asyncio.gather(*tasks)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
    report = Report(
        environment=Environment(ros_distro=ros.distro, ros=ros.kind, rmw=ros.rmw, ros_tutor=__version__),
        exercises=tuple(results),
        duration_s=time.monotonic() - started,
        isolation=isolation.restrictions if isolation else (),
    )
    on_event(CheckFinished(report))
    return report


def _require_descriptors() -> None:
    """Allow this process as many open files as a check needs. Raises EngineError where that is impossible."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    unlimited = resource.RLIM_INFINITY
    most = ENOUGH_DESCRIPTORS if hard == unlimited else min(hard, ENOUGH_DESCRIPTORS)
    if soft != unlimited and soft < most:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
        soft = most
    if soft != unlimited and soft < LEAST_DESCRIPTORS:
        text = f"only {soft} files may be open in a process here, and a check needs {LEAST_DESCRIPTORS}"
        raise EngineError(text, f"allow more (ulimit -n {ENOUGH_DESCRIPTORS}, or nofile in /etc/security/limits.conf)")
