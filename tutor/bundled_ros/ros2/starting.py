"""How to start `ros2` as a subprocess: the installed one or ours."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tutor import run_module
from tutor.errors import CommandError

if TYPE_CHECKING:
    from tutor.ros.environment import RosEnvironment


def ros2_command(ros: RosEnvironment, env: Mapping[str, str]) -> list[str]:
    """Return the command words that start `ros2` in the environment `env`.

    Raises CommandError if the sourced ROS has no ros2.
    """
    if ros.kind == "bundled":
        # -P: a module in the learner's folder must not shadow one of ours.
        return [str(ros.python), "-P", run_module.__file__, "tutor.bundled_ros.ros2"]
    real = shutil.which("ros2", path=env.get("PATH", ""))
    if real is None:
        raise CommandError("the sourced ROS 2 has no ros2 command (install ros-jazzy-ros2cli and ros-jazzy-ros2launch)")
    return [real]


def is_launch_file(path: Path) -> bool:
    """Return whether a file's name marks it as a launch file for `ros2 launch`."""
    return path.name.endswith(("_launch.py", ".launch.py"))
