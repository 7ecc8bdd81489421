"""Check submissions in parallel, and report."""

from __future__ import annotations

import asyncio
import importlib
import resource
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, nullcontext, suppress

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

MIN_DESCRIPTORS, WANTED_DESCRIPTORS = 512, 4096
"""Limits on open files: a check of all exercises needs about 350, and Fast DDS does not report that it lacks some."""

_INTERFACES = (
    "std_msgs",
    "rcl_interfaces",
    "builtin_interfaces",
    "service_msgs",
    "type_description_interfaces",
    "example_interfaces",
)
_MESSAGE_MODULES = tuple(f"{package}.{kind}" for package in _INTERFACES for kind in ("msg", "srv"))
_LAZY_MODULES = (
    "rclpy.serialization",
    "rosidl_generator_py",
    *_MESSAGE_MODULES,
    *(f"{package}.{package}_s__rosidl_typesupport_c" for package in _INTERFACES),
)
"""Modules that would otherwise be imported with the first message.

`refuse_changed_modules` refuses a module whose file changes during a check, even if uv has merely hard-linked the file
into another environment.
"""

NODE_MODULES = ("concurrent.futures", "numpy", "rosidl_generator_py", "yaml", *_MESSAGE_MODULES)
"""What the fork server imports: each node would import it.

Not rclpy itself, whose C library starts threads (of LTTng), which a forked process would lack.
"""


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
    """Judge the submissions in parallel. No process is left when this returns, is cancelled or raises.

    `only`: ids of the criteria to show (None: all). `start_limiter`: shared among checks that run concurrently.
    `isolation`: isolates all processes of the submissions. `first`: end each submission's check at the first required
    criterion that fails, and skip those not judged by then. This process's environment variables are restored
    afterwards. Raises EngineError if checks cannot run here.
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
    from tutor.engine.forking import start_fork_server
    from tutor.engine.modules import load_check
    from tutor.ros import bytecode, process_setup
    from tutor.ros.discovery import require_loopback
    from tutor.ros.environment import detect

    shared_limiter = start_limiter or StartLimiter()
    try:
        require_loopback()
    except OSError as error:
        what = f"nothing can be sent to 127.0.0.1 ({error}), and nodes talk over it"
        raise EngineError(what, "switch the loopback interface on: sudo ip link set lo up") from error
    _require_descriptors()
    ros = detect()
    with ExitStack() as stack:
        try:
            process_setup.prepare_for_rclpy(ros, isolated=True)
            process_setup.keep_stdout()
            await asyncio.to_thread(bytecode.compile_ros_modules, ros)
            fork_server = None if isolation else stack.enter_context(start_fork_server(ros, NODE_MODULES))
            from tutor.engine.runner import Runner  # imports rclpy, whose environment must be set by then
        except (ImportError, OSError, RuntimeError) as error:
            raise EngineError(f"ROS 2 cannot be used here: {error}") from error

        for name in _LAZY_MODULES:
            with suppress(ImportError):
                importlib.import_module(name)
        unchanged.refuse_changed_modules()

        def make_runner(submission: Submission) -> Runner:
            lesson = course.find(submission.exercise)
            check: Check = load_check(lesson)
            return Runner(
                check,
                lesson,
                submission,
                ros,
                only,
                on_event,
                shared_limiter,
                isolation,
                fork_server,
                first=first,
            )

        runners = [make_runner(submission) for submission in submissions]

        def announce_waiting() -> None:
            for runner in runners:
                runner.announce_waiting()

        # A caller that shares a limiter among checks decides itself how many run concurrently.
        turn_socket = isolation.turn_socket if isolation else None
        async with turns.turn(turn_socket, on_wait=announce_waiting) if start_limiter is None else nullcontext():
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
    """Raise this process's limit on open files as far as a check needs. Raises EngineError if that is impossible."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    unlimited = resource.RLIM_INFINITY
    wanted = WANTED_DESCRIPTORS if hard == unlimited else min(hard, WANTED_DESCRIPTORS)
    if soft != unlimited and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
        soft = wanted
    if soft != unlimited and soft < MIN_DESCRIPTORS:
        text = f"only {soft} files may be open in a process here, and a check needs {MIN_DESCRIPTORS}"
        raise EngineError(text, f"allow more (ulimit -n {WANTED_DESCRIPTORS}, or nofile in /etc/security/limits.conf)")
