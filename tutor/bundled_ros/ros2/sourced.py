"""The environment of a sourced terminal: `ros2` and rclpy are found, the workspace's packages, and the app's nodes."""

from __future__ import annotations

import os
import shlex
import shutil
from collections.abc import Mapping
from pathlib import Path

from tutor import interpreter, private_folders
from tutor.bundled_ros.ros2 import sources
from tutor.ros.environment import RosEnvironment, learner_env
from tutor.ros.prefixes import entries, is_bundled, joined

WORKSPACE = "ROS_TUTOR_WORKSPACE"
_OF_CHECKS_ONLY = ("PYTHONUNBUFFERED", "PYTHONIOENCODING")
_USERS_OWN = ("RCUTILS_",)


def sourced_environment(
    ros: RosEnvironment,
    workspace: Path,
    domain_id: int,
    tools: Path,
    environ: Mapping[str, str] = os.environ,
) -> dict[str, str]:
    """The variables of a terminal in which ROS, and the workspace at `workspace`, are sourced.

    `tools` is a folder of the caller's that lives as long as the terminal; programs are put into its `bin`. With an
    installed ROS 2, its own `ros2` is the one; so is any other `ros2` that is on PATH. Raises OSError.
    """
    if ros.kind == "system":
        env = {**environ}
    else:
        log_dir = private_folders.logs(environ)
        env = learner_env(ros, domain_id=domain_id, log_dir=log_dir, package_root=None, isolated=False, environ=environ)
        for name in _OF_CHECKS_ONLY:
            env.pop(name, None)
        env |= {name: value for name, value in environ.items() if name.startswith(_USERS_OWN)}
        # Of our own environment only what a terminal needs: its other programs are none of the user's.
        others = [entry for entry in entries(env, "PATH") if not is_bundled(entry)]
        _write_programs(tools / "bin", ros, with_ros2=shutil.which("ros2", path=joined(others)) is None)
        env["PATH"] = joined([tools / "bin", *others])
    env["ROS_DOMAIN_ID"] = str(domain_id)
    env[WORKSPACE] = str(workspace)
    if roots := _roots(workspace):
        env["PYTHONPATH"] = joined([*roots, *entries(env, "PYTHONPATH")])
    return env


def setup_file(ros: RosEnvironment, workspace: Path, shell: str) -> Path | None:
    """What is to be sourced for a workspace that an installed ROS 2 has built; None where there is none."""
    path = workspace / "install" / f"local_setup.{shell}"
    return path if ros.kind == "system" and path.is_file() else None


def _roots(workspace: Path) -> list[Path]:
    """The folders from which the workspace's Python packages are imported."""
    try:
        packages = list(sources.packages_below(workspace)) if workspace.is_dir() else []
    except OSError:
        return []
    folders = (folder for package in packages for folder in package.modules[-1:])
    return [folder.parent for folder in folders if (folder / "__init__.py").is_file()]


def _write_programs(folder: Path, ros: RosEnvironment, *, with_ros2: bool) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    python = shlex.quote(str(ros.python))
    programs = {"python3": f"{python}", "python": f"{python}"}
    if with_ros2:
        # -P: a module in the learner's folder must not take the place of one of ours.
        programs["ros2"] = f"{interpreter.CTRL_C_LATER} {python} -P -m tutor.bundled_ros.ros2"
    programs["ros-tutor"] = f"{interpreter.CTRL_C_LATER} {shlex.join(interpreter.module_command('tutor'))}"
    for name, command in programs.items():
        path = folder / name
        path.write_text(f'#!/bin/sh\nexec {command} "$@"\n', encoding="utf-8")
        path.chmod(0o755)
