"""Chooses the bundled or the system ROS 2, and builds the environment of every process that uses it. Never mixes both.

Nothing here imports rclpy.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from tutor import __version__
from tutor.ros import bundled_interfaces, prefixes, workspace_interfaces
from tutor.ros.bundled_interfaces import PYTHON
from tutor.ros.discovery import PROFILE, isolated_discovery, loopback_multicast_works, prompt_discovery

if TYPE_CHECKING:
    from tutor.judge.result import Environment

__all__ = ["RosEnvironment", "detect", "learner_env", "loopback_multicast_works", "system_env", "tutor_env"]

DISTRO = "jazzy"
RMW = "rmw_fastrtps_cpp"
# Unless this is set, the wheels' start-up hook restarts the interpreter to set LD_LIBRARY_PATH.
BOOTSTRAP_DONE = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
NO_LOG_FILES = ("--ros-args", "--disable-external-lib-logs")
"""Arguments for rclpy.init in our own processes: they write no log files, so they need no home folder."""

# Variables that a learner's node must not inherit, as they would change its Python, output or discovery.
_DROPPED_PREFIXES = ("RCUTILS_", "PYTEST_", "COV_", "COVERAGE_", "PYTHON", "VIRTUAL_ENV", "__PYVENV_LAUNCHER__")
_DISCOVERY_PREFIXES = ("FASTRTPS_", "FASTDDS_", "CYCLONEDDS_", "ZENOH_", "RMW_")
_ROS_PREFIXES = ("ROS_", "AMENT_", "COLCON_", "CMAKE_PREFIX_PATH", "RCL_")
_ROS_PATH_VARIABLES = ("CMAKE_PREFIX_PATH", "PKG_CONFIG_PATH")
_PATH_VARIABLES = ("PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "AMENT_PREFIX_PATH", *_ROS_PATH_VARIABLES)
_OWN_VARIABLES = ("ROS_TUTOR_",)  # such as ROS_TUTOR_WORKSPACE
# The user's own discovery settings, which "run" keeps, unlike a check.
_USER_DISCOVERY = (
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_DISCOVERY_SERVER",
    "ROS_LOCALHOST_ONLY",
    "ROS_STATIC_PEERS",
    "ROS_SUPER_CLIENT",
)
_SYSTEM_ROS_VARIABLES = (
    "ROS_DISTRO",
    "ROS_VERSION",
    "ROS_PYTHON_VERSION",
    "ROS_ETC_DIR",
    "ROS_PACKAGE_PATH",
    "AMENT_",
    "COLCON_",
)
UNBUFFERED = "PYTHONUNBUFFERED"
UNBUFFERED_BY_US = "ros-tutor"
"""Our value for PYTHONUNBUFFERED, by which `ros2` can tell that we set it, and unset it for its own children."""


@dataclass(frozen=True, slots=True)
class RosEnvironment:
    """The ROS 2 in use.

    `python` runs the learners' code. `problems` holds one sentence for each problem with our environment variables,
    such as another sourced distribution; we remove those variables, so checks work all the same.
    """

    kind: Literal["bundled", "system"]
    distro: str
    python: Path
    rmw: str
    problems: tuple[str, ...] = ()

    def for_report(self) -> Environment:
        """Return what a report says of the software that a check ran on."""
        from tutor.judge.result import Environment  # late: every `ros2` command imports this module

        return Environment(ros_distro=self.distro, ros=self.kind, rmw=self.rmw, ros_tutor=__version__)


def detect(environ: Mapping[str, str] = os.environ) -> RosEnvironment:
    """Choose the ROS 2 to use: a sourced and complete ROS 2 Jazzy, else the bundled one."""
    bundled = Path(sys.executable)
    sourced = [Path(entry) for entry in prefixes.without_bundled(environ, "AMENT_PREFIX_PATH")]
    distro = environ.get("ROS_DISTRO", "")
    problems = _problems(environ, distro, sourced)
    if problems or not distro:
        return RosEnvironment("bundled", DISTRO, bundled, RMW, problems)
    home = next(prefix for prefix in sourced if prefixes.rclpy_site(prefix))
    python = _system_python(home, environ)
    if python is None:
        text = f"ROS 2 {DISTRO} is sourced ({home}), but no {PYTHON} was found to run it with."
        return RosEnvironment("bundled", DISTRO, bundled, RMW, (text,))
    return RosEnvironment("system", DISTRO, python, RMW)


def learner_env(
    ros: RosEnvironment,
    *,
    domain_id: int,
    log_dir: Path,
    package_root: Path | None,
    isolated: bool,
    environ: Mapping[str, str] = os.environ,
) -> dict[str, str]:
    """Return the environment for a learner's process, which runs with `ros.python`.

    `package_root` is a folder to import the learner's package from. `isolated` keeps the process's DDS traffic on this
    host (for a check); otherwise the user's own discovery settings apply (for a run, visible to their other terminals).
    """
    env = _ros_env(ros, environ, first_on_path=[] if package_root is None else [package_root])
    env.update(_discovery_env(ros, isolated, environ))
    if not isolated:
        workspace_interfaces.keep(env, environ)
        env[UNBUFFERED] = environ.get(UNBUFFERED) or UNBUFFERED_BY_US
    env["ROS_DOMAIN_ID"] = str(domain_id)
    env["ROS_LOG_DIR"] = str(log_dir)
    return env


def tutor_env(ros: RosEnvironment, *, isolated: bool, environ: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return the environment for our own processes that import rclpy, which run with `sys.executable`.

    A process started with it does not have to restart itself in `tutor.ros.process_setup.prepare_for_rclpy`.
    """
    env = _ros_env(ros, environ, first_on_path=[])
    env.update(_discovery_env(ros, isolated, environ))
    if isolated:
        env["RMW_FASTRTPS_USE_QOS_FROM_XML"] = "1"  # the memory policy of our own endpoints, see the profile
    else:
        workspace_interfaces.keep(env, environ)
    for name in ("ROS_DOMAIN_ID", "ROS_LOG_DIR"):
        if name in environ:
            env[name] = environ[name]
    return env


def system_env(environ: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return the environment in which an installed ROS 2 was sourced: without what our own interpreter has added.

    When it starts, a hook of the wheels puts their libraries on LD_LIBRARY_PATH.
    """
    kept = {name: prefixes.without_bundled(environ, name) for name in _PATH_VARIABLES if name in environ}
    env = {name: value for name, value in environ.items() if name not in (BOOTSTRAP_DONE, *kept)}
    return env | {name: prefixes.join_entries(left) for name, left in kept.items() if left}


def _problems(environ: Mapping[str, str], distro: str, sourced: list[Path]) -> tuple[str, ...]:
    foreign_paths = [e for e in prefixes.entries(environ, "PYTHONPATH") if prefixes.is_foreign_ros(e)]
    if not distro and not sourced and not foreign_paths:
        return ()
    if distro and distro != DISTRO:
        return (f"ROS 2 {distro} is sourced (ROS_DISTRO={distro}); the exercises need {DISTRO}.",)
    if not distro:
        left_over = sourced[0] if sourced else foreign_paths[0]
        return (f"ROS is only partly sourced: ROS_DISTRO is not set, but {left_over} is in the environment.",)
    others = sorted({name for path in [*sourced, *map(Path, foreign_paths)] if (name := _distro_of(path))} - {DISTRO})
    if others:
        return (f"More than one ROS is sourced: {DISTRO} and {', '.join(others)}.",)
    homes = [prefix for prefix in sourced if prefixes.rclpy_site(prefix)]
    if not homes:
        return (f"ROS_DISTRO is {DISTRO}, but no folder of AMENT_PREFIX_PATH holds rclpy for {PYTHON}.",)
    site = prefixes.rclpy_site(homes[0])
    own_python = (homes[0] / "bin" / PYTHON).exists()  # it finds its own folders, as in a conda environment
    if not own_python and str(site) not in prefixes.entries(environ, "PYTHONPATH"):
        return (f"ROS is only partly sourced: {site} is not in PYTHONPATH.",)
    if not own_python and str(homes[0] / "lib") not in prefixes.entries(environ, "LD_LIBRARY_PATH"):
        return (f"ROS is only partly sourced: {homes[0] / 'lib'} is not in LD_LIBRARY_PATH.",)
    if not any(prefixes.holds_package(prefix, RMW) for prefix in sourced):
        return (f"The sourced ROS 2 {DISTRO} has no {RMW}, which the checks use.",)
    return ()


def _distro_of(path: Path) -> str:
    """Return the distribution of a path such as /opt/ros/<distribution>/lib; empty for other paths."""
    return path.parts[3] if len(path.parts) > 3 and path.is_relative_to("/opt/ros") else ""


def _system_python(home: Path, environ: Mapping[str, str]) -> Path | None:
    own = [home / "bin" / PYTHON, Path("/usr/bin", PYTHON), Path("/usr/local/bin", PYTHON)]
    base = Path(getattr(sys, "_base_executable", ""))
    found = shutil.which(PYTHON, path=prefixes.join_entries(prefixes.without_bundled(environ, "PATH")))
    candidates = [*own, base, *([Path(found)] if found else [])]
    return next((python for python in candidates if python.is_file() and not prefixes.is_bundled(python)), None)


def _ros_env(ros: RosEnvironment, environ: Mapping[str, str], first_on_path: list[Path]) -> dict[str, str]:
    kept = (*_OWN_VARIABLES, *(_SYSTEM_ROS_VARIABLES if ros.kind == "system" else ()))
    env = {
        name: value
        for name, value in environ.items()
        if not name.startswith(_DROPPED_PREFIXES + _DISCOVERY_PREFIXES)
        and (not name.startswith(_ROS_PREFIXES) or name.startswith(kept))
    }
    if ros.kind == "bundled":
        binaries = Path(sys.prefix) / "bin"
        env["PATH"] = prefixes.join_entries([binaries, *prefixes.without_ros(environ, "PATH")])
        env["LD_LIBRARY_PATH"] = prefixes.join_entries(
            [*prefixes.bundled_libraries(), *prefixes.without_ros(environ, "LD_LIBRARY_PATH")]
        )
        ours = (bundled_interfaces.startup_folder(), bundled_interfaces.site_packages())
        python_path = [*map(str, ours), *prefixes.without_ros(environ, "PYTHONPATH")]
        env["AMENT_PREFIX_PATH"] = prefixes.join_entries([bundled_interfaces.prefix(), sys.prefix])
        rest = {name: prefixes.without_ros(environ, name) for name in _ROS_PATH_VARIABLES}
    else:
        rest = {name: prefixes.without_bundled(environ, name) for name in _PATH_VARIABLES}
        python_path = rest.pop("PYTHONPATH")
    env["PYTHONPATH"] = prefixes.join_entries([*first_on_path, *python_path])
    for name, left in rest.items():
        env.pop(name, None)
        if left:
            env[name] = prefixes.join_entries(left)
    env[BOOTSTRAP_DONE] = "1"
    env["RMW_IMPLEMENTATION"] = ros.rmw
    env[UNBUFFERED] = "1"  # otherwise output to a pipe would be delayed
    env["PYTHONDONTWRITEBYTECODE"] = "1"  # no __pycache__ beside a learner's files
    env["PYTHONIOENCODING"] = "utf-8"
    # Message modules import numpy, whose threads spin when loaded: a quarter of the CPU time of a node's start.
    env.setdefault("OPENBLAS_NUM_THREADS", "1")
    return env


def _discovery_env(ros: RosEnvironment, isolated: bool, environ: Mapping[str, str]) -> dict[str, str]:
    if isolated:
        return isolated_discovery()
    user_settings = {
        name: value
        for name, value in environ.items()
        if name in _USER_DISCOVERY or name.startswith(_DISCOVERY_PREFIXES)
    }
    user_settings.pop("RMW_IMPLEMENTATION", None)
    user_settings = {name: value for name, value in user_settings.items() if value != str(PROFILE)}
    has_profile = any(name.endswith("_DEFAULT_PROFILES_FILE") for name in user_settings)
    return user_settings if has_profile or ros.kind == "system" else {**prompt_discovery(), **user_settings}
