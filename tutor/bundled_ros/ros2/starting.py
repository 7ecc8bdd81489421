"""How to start `ros2` from outside: the installed one, or ours."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tutor.errors import CommandError

if TYPE_CHECKING:
    from tutor.ros.environment import RosEnvironment


def ros2_command(ros: RosEnvironment, env: Mapping[str, str]) -> list[str]:
    """The first words of a `ros2` command that is to be run in the environment `env`.

    Raises CommandError where the ROS that is sourced has no ros2.
    """
    if ros.kind == "bundled":
        # -P: a module in the learner's folder must not take the place of one of ours.
        return [str(ros.python), "-P", "-m", "tutor.bundled_ros.ros2"]
    real = shutil.which("ros2", path=env.get("PATH", ""))
    if real is None:
        raise CommandError("the sourced ROS 2 has no ros2 command (install ros-jazzy-ros2cli and ros-jazzy-ros2launch)")
    return [real]


def is_launch_file(path: Path) -> bool:
    """Whether a file's name says that it is a launch file, to be run by `ros2 launch`."""
    return path.name.endswith(("_launch.py", ".launch.py"))
