"""Prepare this process for checks: the ROS to use, its modules, and a fork server."""

from __future__ import annotations

import asyncio
import importlib
import os
import resource
from collections.abc import AsyncIterator
from contextlib import ExitStack, asynccontextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tutor.errors import EngineError
from tutor.process.fork_link import ForkServerLink
from tutor.ros.environment import RosEnvironment

if TYPE_CHECKING:
    from tutor.engine.sandbox import Sandboxes

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


class Prepared(NamedTuple):
    """The ROS that checks use, and where nodes are forked; None: in their sandboxes, or started without a fork server.

    `tools`: a folder with the programs of a sourced terminal, such as `ros2`, for the nodes.
    """

    ros: RosEnvironment
    fork_server: ForkServerLink | None
    tools: Path


@asynccontextmanager
async def prepare(*, sandboxes: Sandboxes | None = None) -> AsyncIterator[Prepared]:
    """Import what a check needs, which takes most of a second, and start a fork server, or those of the sandboxes.

    Restores the environment variables of this process at the end. Raises EngineError if checks cannot run here.
    """
    from tutor import private_folders
    from tutor.bundled_ros.ros2 import sourced
    from tutor.engine.forking import start_fork_server
    from tutor.ros import bytecode, process_setup
    from tutor.ros.discovery import require_loopback
    from tutor.ros.environment import detect

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
            fork_server = None
            if sandboxes is not None:
                stack.enter_context(sandboxes).start(ros, tools, NODE_MODULES)
            else:
                fork_server = stack.enter_context(start_fork_server(ros, NODE_MODULES))
            importlib.import_module("tutor.engine.runner")  # with rclpy, whose environment must be set by now
        except (ImportError, OSError, RuntimeError) as error:
            raise EngineError(f"ROS 2 cannot be used here: {error}") from error
        for name in _LAZY_MODULES:
            with suppress(ImportError):
                importlib.import_module(name)
        yield Prepared(ros, fork_server, tools)


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
