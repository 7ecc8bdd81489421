"""The machine that checks run on: its ROS, how processes start there, and its limits."""

from __future__ import annotations

import asyncio
import importlib
import os
import resource
from collections.abc import AsyncIterator, Iterable
from contextlib import ExitStack, asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from tutor import private_folders
from tutor.bundled_ros.ros2 import sourced
from tutor.engine.environment import LAZY_MODULES, NODE_MODULES, start_fork_server
from tutor.engine.isolation import Isolation, Sandbox, Sandboxes
from tutor.engine.scheduling import TURN_LIMIT_S, StartLimiter
from tutor.errors import EngineError
from tutor.judge.submission import Submission
from tutor.process.spawner import DIRECTLY, Spawner
from tutor.ros.environment import RosEnvironment, detect

MIN_DESCRIPTORS, WANTED_DESCRIPTORS = 512, 4096
"""Limits on open files: a check of all exercises needs about 350, and Fast DDS does not report that it lacks some."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits on a check, in seconds.

    `check_s`: what is not judged by then is an error. `turn_s`: how long it waits for its turn at most; with None, it
    takes none, since its caller decides how many run at a time.
    """

    check_s: float | None = None
    turn_s: float | None = TURN_LIMIT_S


@dataclass(frozen=True, slots=True)
class Machine:
    """What checks run on; made by `prepare`.

    `tools`: a folder with the programs of a sourced terminal, such as `ros2`, for the nodes. `spawner`: starts nodes
    that are not isolated; `sandboxes`: where they are. `starts`: limits how many start at a time, in all checks.
    """

    ros: RosEnvironment
    tools: Path | None = None
    spawner: Spawner = DIRECTLY
    sandboxes: Sandboxes | None = None
    starts: StartLimiter = field(default_factory=StartLimiter)
    limits: Limits = Limits()

    @property
    def isolation(self) -> Isolation | None:
        """How submissions are isolated; None if they are not."""
        return self.sandboxes.isolation if self.sandboxes else None

    def sandbox_of(self, path: Path) -> Sandbox | None:
        """Return the sandbox of the submission that a file belongs to; None without isolation. Raises EngineError."""
        return self.sandboxes.of(path) if self.sandboxes else None


@asynccontextmanager
async def prepare(isolation: Isolation | None = None, submissions: Iterable[Submission] = ()) -> AsyncIterator[Machine]:
    """Import what a check needs, which takes most of a second, and start a fork server.

    `isolation`: with a sandbox, and a fork server in it, for each of the submissions. Restores the environment
    variables of this process at the end. Raises EngineError if checks cannot run here.
    """
    from tutor.ros import bytecode, process_setup
    from tutor.ros.discovery import require_loopback

    try:
        require_loopback()
    except OSError as error:
        what = f"nothing can be sent to 127.0.0.1 ({error}), and nodes talk over it"
        raise EngineError(what, "switch the loopback interface on: sudo ip link set lo up") from error
    _require_descriptors()
    with process_setup.environment_restored(), ExitStack() as stack:
        ros = detect()
        try:
            process_setup.prepare_for_rclpy(ros, isolated=True)
            process_setup.keep_stdout()
            await asyncio.to_thread(bytecode.compile_ros_modules, ros)
            tools = stack.enter_context(private_folders.temporary("tools"))
            sourced.write_programs(tools, ros, os.environ)
            if isolation is not None:
                sandboxes = stack.enter_context(Sandboxes(isolation, submissions))
                sandboxes.start(ros, tools, NODE_MODULES)
                machine = Machine(ros, tools, sandboxes=sandboxes)
            else:
                machine = Machine(ros, tools, Spawner(stack.enter_context(start_fork_server(ros, NODE_MODULES))))
            importlib.import_module("tutor.engine.runner")  # with rclpy, whose environment must be set by now
        except (ImportError, OSError, RuntimeError) as error:
            raise EngineError(f"ROS 2 cannot be used here: {error}") from error
        for name in LAZY_MODULES:
            with suppress(ImportError):
                importlib.import_module(name)
        yield machine


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
