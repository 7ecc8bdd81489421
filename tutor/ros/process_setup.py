"""Our own process as a user of ROS: the right libraries, the right modules, none of the other ROS."""

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
from tutor.ros import prefixes, shared_memory
from tutor.ros.environment import RosEnvironment, tutor_env

_RESTARTED = "_ROS_TUTOR_RESTARTED"
_NOT_ROS = ("ros_tutor", "ros_wheels_bootstrapper")
_OF_ROS = ("ROS_", "RMW_", "AMENT_", "FASTRTPS_", "FASTDDS_", "RCUTILS_", "OPENBLAS_")

_in_use: tuple[object, ...] | None = None
"""The ROS that this process was prepared for: once rclpy is imported, it can be no other."""

_users_environ: dict[str, str] = {}
_preparations = 0


@contextmanager
def environment_restored() -> Iterator[None]:
    """Give the user's environment back at the end of whatever prepares this process for rclpy.

    A node that the user runs later from this process would be set up as a check's otherwise. These may overlap: the
    last to end restores.
    """
    global _preparations
    if not _preparations:
        _users_environ.clear()
        _users_environ.update(os.environ)
    _preparations += 1
    try:
        yield
    finally:
        _preparations -= 1
        if not _preparations:
            for name in set(os.environ) - set(_users_environ):
                del os.environ[name]
            os.environ.update(_users_environ)


def prepare_for_rclpy(ros: RosEnvironment, *, isolated: bool) -> None:
    """Prepare this process for `import rclpy` (the observer's side). Call it before anything else.

    Where this process was started with library folders of the other ROS, it restarts itself, once, without them: the
    loader reads LD_LIBRARY_PATH only then. It may be called again for the same ROS. Raises RuntimeError where rclpy was
    imported before the first call or for another ROS, OSError where shared memory is full, and whatever
    `tutor.ros.bundled_interfaces.activate` raises where the bundled interfaces are missing.
    """
    global _in_use
    interpreter.answer_ctrl_c()  # where this process has restarted itself
    shared_memory.require_enough()
    env = tutor_env(ros, isolated=isolated)
    if "rclpy" in sys.modules and _in_use != _identity(ros):
        raise RuntimeError("rclpy is imported already: choose the ROS before")
    _in_use = _identity(ros)
    if _wrong_libraries(ros) and os.environ.get(_RESTARTED) != ros.kind:
        interpreter.become([sys.executable, *sys.orig_argv[1:]], {**env, _RESTARTED: ros.kind})
    for name in set(os.environ) - set(env):
        if name.startswith(_OF_ROS):
            del os.environ[name]
    os.environ.update({name: value for name, value in env.items() if name.startswith(_OF_ROS)})
    if ros.kind == "system":
        if sys.flags.isolated:
            interpreter.add_python_path(env)
        if not any(isinstance(finder, _NoBundledRos) for finder in sys.meta_path):
            sys.meta_path.insert(0, _NoBundledRos())
        return
    sys.path[:] = [entry for entry in sys.path if not prefixes.is_foreign_ros(entry)]
    from tutor.ros import bundled_interfaces

    bundled_interfaces.activate()


def keep_stdout() -> None:
    """Keep standard output for us: what ROS's libraries write goes to stderr. Call it after `prepare_for_rclpy`."""
    try:
        if sys.stdout.fileno() != 1 or sys.stderr.fileno() != 2:
            return
    except (AttributeError, OSError, ValueError):  # one of them is closed, or no file
        return
    sys.stdout.flush()
    ours = os.dup(1)
    os.dup2(2, 1)
    sys.stdout = os.fdopen(ours, "w", encoding=sys.stdout.encoding, errors=sys.stdout.errors)


def _identity(ros: RosEnvironment) -> tuple[object, ...]:
    # Without its problems: they are those of the variables around us, which `prepare_for_rclpy` has cleaned.
    return ros.kind, ros.distro, ros.python, ros.rmw


def _wrong_libraries(ros: RosEnvironment) -> bool:
    wrong = prefixes.is_bundled if ros.kind == "system" else prefixes.is_foreign_ros
    return any(wrong(entry) for entry in prefixes.entries(_started_with(), "LD_LIBRARY_PATH"))


@cache
def _started_with() -> dict[str, str]:
    """What the loader was given when this process started, whatever os.environ says by now.

    Read once: when learners' processes run, it is closed to us (`prctl.guard`).
    """
    text = Path("/proc/self/environ").read_bytes().decode(errors="surrogateescape")
    return dict(variable.partition("=")[::2] for variable in text.split("\0"))


def _lines(record: Path) -> list[str]:
    return record.read_text(encoding="utf-8", errors="replace").splitlines()


class _NoBundledRos(MetaPathFinder):
    """Refuses to import a module of the bundled ROS: what a system ROS lacks is missing there, never mixed in."""

    @cached_property
    def _bundled(self) -> frozenset[str]:
        records = (Path(sys.prefix) / prefixes.SITE_PACKAGES).glob("ros_*.dist-info/RECORD")
        lines = (line for record in records if not record.parent.name.startswith(_NOT_ROS) for line in _lines(record))
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
