"""The environment of a sourced terminal, which finds `ros2`, rclpy, the workspace's packages and the app's nodes."""

from __future__ import annotations

import os
import shlex
import shutil
from collections.abc import Mapping
from pathlib import Path

from tutor import interpreter, private_folders
from tutor.bundled_ros.ros2 import absent, sources
from tutor.bundled_ros.ros2.starting import ros2_command
from tutor.ros import workspace_interfaces
from tutor.ros.environment import RosEnvironment, learner_env, system_env
from tutor.ros.prefixes import PACKAGE_INDEX, SITE_PACKAGES, entries, is_bundled, join_entries

WORKSPACE = "ROS_TUTOR_WORKSPACE"
_CHECK_ONLY_VARIABLES = ("PYTHONUNBUFFERED", "PYTHONIOENCODING")
_USER_PREFIXES = ("RCUTILS_",)


def sourced_environment(
    ros: RosEnvironment,
    workspace: Path,
    domain_id: int,
    tools: Path,
    environ: Mapping[str, str] = os.environ,
) -> dict[str, str]:
    """Return the environment of a terminal in which ROS and the workspace at `workspace` are sourced.

    `tools` is a folder that the caller keeps as long as the terminal; programs are written into its `bin`. The `ros2`
    of an installed ROS 2, or any other on PATH, takes precedence over ours. Raises OSError.
    """
    if ros.kind == "system":
        env = system_env(environ)
    else:
        log_dir = private_folders.logs(environ)
        env = learner_env(ros, domain_id=domain_id, log_dir=log_dir, package_root=None, isolated=False, environ=environ)
        for name in _CHECK_ONLY_VARIABLES:
            env.pop(name, None)
        env |= {name: value for name, value in environ.items() if name.startswith(_USER_PREFIXES)}
        write_programs(tools, ros, env)
        add_programs(env, tools)
    env["ROS_DOMAIN_ID"] = str(domain_id)
    add_workspace(env, workspace)
    return env


def write_programs(tools: Path, ros: RosEnvironment, environ: Mapping[str, str]) -> None:
    """Write the programs of a terminal into `tools`, which is to be kept as long as they are needed. Raises OSError.

    None if ROS 2 is installed, which has them; no `ros2` if there is another one on PATH.
    """
    if ros.kind == "bundled":
        others = _without_our_programs(environ)
        _write_programs(tools / "bin", ros, with_ros2=shutil.which("ros2", path=join_entries(others)) is None)
        absent.write_programs(tools / "absent", others)


def add_programs(env: dict[str, str], tools: Path) -> None:
    """Put the programs of `write_programs`, if any, on PATH.

    They take the place of our own virtual environment's programs, of which a terminal needs only these few.
    """
    if (tools / "bin").is_dir():
        env["PATH"] = join_entries([tools / "bin", *_without_our_programs(env), tools / "absent"])


def add_workspace(env: dict[str, str], workspace: Path) -> None:
    """Make `ros2` and Python find the packages of this workspace. With an installed ROS 2, see also `setup_file`.

    Its message types are found as far as they are built (see `tutor.interfaces`).
    """
    env[WORKSPACE] = str(workspace)
    if roots := _import_roots(workspace):
        env["PYTHONPATH"] = join_entries([*roots, *entries(env, "PYTHONPATH")])
    workspace_interfaces.add(env, workspace)


def add_built_packages(env: dict[str, str], workspace: Path) -> None:
    """Add what `colcon build` has installed in a workspace, as its setup file does, but without running that."""
    install = workspace / "install"
    built = [folder for folder in (install, *sorted(install.glob("*/"))) if (folder / PACKAGE_INDEX).is_dir()]
    sites = [site for folder in built if (site := folder / SITE_PACKAGES).is_dir()]
    for name, folders in (("AMENT_PREFIX_PATH", built), ("PYTHONPATH", sites)):
        if folders:
            env[name] = join_entries([*folders, *entries(env, name)])


def _without_our_programs(environ: Mapping[str, str]) -> list[str]:
    return [entry for entry in entries(environ, "PATH") if not is_bundled(entry)]


def setup_file(ros: RosEnvironment, workspace: Path, shell: str) -> Path | None:
    """Return the setup file of a workspace that an installed ROS 2 has built; None if there is none."""
    path = workspace / "install" / f"local_setup.{shell}"
    return path if ros.kind == "system" and path.is_file() else None


def _import_roots(workspace: Path) -> list[Path]:
    """Return the folders from which the workspace's Python packages are imported."""
    try:
        return list(sources.import_roots(workspace)) if workspace.is_dir() else []
    except OSError:
        return []


def _write_programs(folder: Path, ros: RosEnvironment, *, with_ros2: bool) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    python = shlex.quote(str(ros.python))
    programs = {"python3": f"{python}", "python": f"{python}"}
    if with_ros2:
        programs["ros2"] = f"{interpreter.BLOCK_SIGINT_PREFIX} {shlex.join(ros2_command(ros, {}))}"
    programs["ros-tutor"] = f"{interpreter.BLOCK_SIGINT_PREFIX} {shlex.join(interpreter.module_command('tutor'))}"
    for name, command in programs.items():
        path = folder / name
        path.write_text(f'#!/bin/sh\nexec {command} "$@"\n', encoding="utf-8")
        path.chmod(0o755)
