"""Prepares our own process for rclpy: the right libraries and modules, and nothing of the other ROS."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache, cached_property
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType

from tutor import interpreter
from tutor.ros import prefixes, shared_memory, workspace_interfaces
from tutor.ros.environment import RosEnvironment, tutor_env

_RESTARTED_VARIABLE = "_ROS_TUTOR_RESTARTED"
_NON_ROS_WHEELS = ("ros_tutor", "ros_wheels_bootstrapper")
_ROS_VARIABLE_PREFIXES = ("ROS_", "RMW_", "AMENT_", "FASTRTPS_", "FASTDDS_", "RCUTILS_", "OPENBLAS_")

_prepared_for: tuple[object, ...] | None = None
"""The ROS that this process was prepared for, which cannot change once rclpy is imported."""

_users_environ: dict[str, str] = {}
_active_blocks = 0


@contextmanager
def environment_restored() -> Iterator[None]:
    """Restore the user's environment after a block that prepares this process for rclpy.

    Otherwise a node that the user runs later from this process would get the settings of a check. Blocks may overlap:
    the last one to end restores.
    """
    global _active_blocks
    if not _active_blocks:
        _users_environ.clear()
        _users_environ.update(os.environ)
    _active_blocks += 1
    try:
        yield
    finally:
        _active_blocks -= 1
        if not _active_blocks:
            for name in set(os.environ) - set(_users_environ):
                del os.environ[name]
            os.environ.update(_users_environ)


def prepare_for_rclpy(ros: RosEnvironment, *, isolated: bool) -> None:
    """Prepare this process for `import rclpy`. Call this before anything else.

    If the process was started with library folders of the other ROS, it restarts itself once without them, since the
    loader reads LD_LIBRARY_PATH only at process start. May be called again for the same ROS. Raises RuntimeError if
    rclpy was imported before the first call or for another ROS, OSError if shared memory is full, and whatever
    `tutor.ros.bundled_interfaces.activate` raises if the bundled interfaces are missing.
    """
    global _prepared_for
    interpreter.unblock_sigint()  # in case this process has restarted itself
    shared_memory.require_enough()
    env = tutor_env(ros, isolated=isolated)
    if "rclpy" in sys.modules and _prepared_for != _identity(ros):
        raise RuntimeError("rclpy is already imported: choose the ROS first")
    _prepared_for = _identity(ros)
    if _has_wrong_libraries(ros) and os.environ.get(_RESTARTED_VARIABLE) != ros.kind:
        interpreter.exec_program([sys.executable, *sys.orig_argv[1:]], {**env, _RESTARTED_VARIABLE: ros.kind})
    for name in set(os.environ) - set(env):
        if name.startswith(_ROS_VARIABLE_PREFIXES):
            del os.environ[name]
    os.environ.update({name: value for name, value in env.items() if name.startswith(_ROS_VARIABLE_PREFIXES)})
    if ros.kind == "system":
        if sys.flags.isolated:
            interpreter.add_python_path(env)
        if not any(isinstance(finder, _NoBundledRos) for finder in sys.meta_path):
            sys.meta_path.insert(0, _NoBundledRos())
        return
    sys.path[:] = [entry for entry in sys.path if not prefixes.is_foreign_ros(entry)]
    from tutor.ros import bundled_interfaces

    bundled_interfaces.activate()
    if sys.flags.isolated:  # Python has ignored PYTHONPATH, by which the packages of a workspace are found
        sys.path += [entry for entry in prefixes.entries(env, "PYTHONPATH") if workspace_interfaces.is_built(entry)]


def keep_stdout() -> None:
    """Reserve stdout for us: redirect what ROS libraries write there to stderr. Call after `prepare_for_rclpy`."""
    try:
        if sys.stdout.fileno() != 1 or sys.stderr.fileno() != 2:
            return
    except (AttributeError, OSError, ValueError):  # one of them is closed, or not a file
        return
    sys.stdout.flush()
    ours = os.dup(1)
    os.dup2(2, 1)
    sys.stdout = os.fdopen(ours, "w", encoding=sys.stdout.encoding, errors=sys.stdout.errors)


def _identity(ros: RosEnvironment) -> tuple[object, ...]:
    # Without `problems`: they describe environment variables, which `prepare_for_rclpy` cleans up.
    return ros.kind, ros.distro, ros.python, ros.rmw


def _has_wrong_libraries(ros: RosEnvironment) -> bool:
    wrong = prefixes.is_bundled if ros.kind == "system" else prefixes.is_foreign_ros
    present = prefixes.entries(_initial_environ(), "LD_LIBRARY_PATH")
    return any(wrong(entry) and not workspace_interfaces.is_built(entry) for entry in present)


@cache
def _initial_environ() -> dict[str, str]:
    """Return the environment that the loader saw when this process started, unlike os.environ.

    Cached, because /proc/self/environ is unreadable once learners' processes run (see `prctl.guard`).
    """
    text = Path("/proc/self/environ").read_bytes().decode(errors="surrogateescape")
    return dict(variable.partition("=")[::2] for variable in text.split("\0"))


def _read_lines(record: Path) -> list[str]:
    return record.read_text(encoding="utf-8", errors="replace").splitlines()


class _NoBundledRos(MetaPathFinder):
    """Blocks imports from the bundled ROS: a module missing from a system ROS is an error, never mixed in."""

    @cached_property
    def _bundled(self) -> frozenset[str]:
        records = (Path(sys.prefix) / prefixes.SITE_PACKAGES).glob("ros_*.dist-info/RECORD")
        lines = (
            line
            for record in records
            if not record.parent.name.startswith(_NON_ROS_WHEELS)
            for line in _read_lines(record)
        )
        return frozenset(line.partition("/")[0] for line in lines if "/" in line)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if path is not None or fullname not in self._bundled:
            return None
        found = PathFinder.find_spec(fullname, [entry for entry in sys.path if not prefixes.is_bundled(entry)])
        if found is None:
            raise ModuleNotFoundError(f"the sourced ROS has no module named {fullname!r}", name=fullname)
        return found
