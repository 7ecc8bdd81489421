"""The environment in which a learner's node is started: its variables, its package's folders, and its fork server."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

from tutor.bundled_ros.ros2 import sourced, sources
from tutor.process.fork_link import ForkServerLink
from tutor.ros.environment import RosEnvironment, learner_env

_INTERFACES = (
    "std_msgs",
    "rcl_interfaces",
    "builtin_interfaces",
    "service_msgs",
    "type_description_interfaces",
    "example_interfaces",
)
_MESSAGE_MODULES = tuple(f"{package}.{kind}" for package in _INTERFACES for kind in ("msg", "srv"))

LAZY_MODULES = (
    "rclpy.serialization",
    "rosidl_generator_py",
    *_MESSAGE_MODULES,
    *(f"{package}.{package}_s__rosidl_typesupport_c" for package in _INTERFACES),
)
"""Modules that our own process would otherwise import with the first message, while a learner's program runs."""

NODE_MODULES = ("concurrent.futures", "numpy", "rosidl_generator_py", "yaml", *_MESSAGE_MODULES)
"""What the fork server imports: each node would import it.

Not rclpy itself, whose C library starts threads (of LTTng), which a forked process would lack.
"""


def package_folder(path: Path) -> Path:
    """Return the folder of the file's ROS package, else the parent of its Python package, else its own folder."""
    candidates = [path.parent, *path.parents[1:3]]
    return next(
        (folder for folder in candidates if (folder / "package.xml").is_file()), package_root(path) or path.parent
    )


def package_root(path: Path) -> Path | None:
    """Return the folder from which the file's package can be imported; None if the file is not in a package."""
    return path.parent.parent if (path.parent / "__init__.py").is_file() else None


def node_env(ros: RosEnvironment, domain_id: int, log_dir: Path, package_root: Path | None) -> dict[str, str]:
    """Return the environment of a node that is checked, without what belongs to its workspace (`source_workspace`)."""
    env = learner_env(
        ros, domain_id=domain_id, log_dir=log_dir, package_root=package_root, isolated=True, environ=os.environ
    )
    env["TMPDIR"] = str(log_dir)  # temporary files are deleted with the run
    env["PYTHONFAULTHANDLER"] = "1"  # see tutor.engine.ending.dump_stacks
    return env


def source_workspace(env: dict[str, str], ros: RosEnvironment, path: Path, tools: Path | None) -> None:
    """Make a learner's file run as in a terminal in which ROS and the file's workspace are sourced.

    `tools` holds the programs of such a terminal (see `sourced.write_programs`).
    """
    if tools is not None:
        sourced.add_programs(env, tools)
    if (workspace := sources.workspace_around(path)) is not None:
        if ros.kind == "system":
            sourced.add_built_packages(env, workspace)
        sourced.add_workspace(env, workspace)


def start_fork_server(
    ros: RosEnvironment,
    modules: Iterable[str],
    env: Mapping[str, str] | None = None,
    wrapper: Sequence[str] = (),
) -> AbstractContextManager[ForkServerLink | None]:
    """Start a fork server for nodes; None if it cannot be started, and then nodes start without one.

    `env`: its environment, by default that of a node; `wrapper`: see `ForkServerLink`.
    """
    try:
        return ForkServerLink(ros.python, env or node_env(ros, 0, Path(os.devnull), None), modules, wrapper)
    except OSError:
        return nullcontext()
