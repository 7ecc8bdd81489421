"""Programs of an installed ROS 2 that tutorials name and that are not here: each says so, and what to do instead."""

from __future__ import annotations

import shlex
import shutil
from collections.abc import Iterable
from pathlib import Path

from tutor.ros.prefixes import join_entries

_NEEDS_ROS = "needs an installed ROS 2"
_COMMAND_NOT_FOUND = 127

ABSENT = {
    "colcon": "is not installed, and not needed here: `ros2 run` and `ros2 launch` take the Python packages in src as "
    "they are, so there is nothing to build, and no install/setup.bash to source",
    "gz": _NEEDS_ROS,
    "rosdep": "is not installed, and not needed here: ros-tutor brings what the exercises depend on",
    "rqt": f"{_NEEDS_ROS}; the app's Live page shows topics, parameters and services",
    "rqt_console": f"{_NEEDS_ROS}; `ros2 topic echo /rosout` shows the log messages of all nodes",
    "rqt_graph": f"{_NEEDS_ROS}; the app's Live page shows the graph, `ros2 node list` and `ros2 node info` its parts",
    "rqt_plot": f"{_NEEDS_ROS}; the app's Live page plots topics",
    "rviz2": _NEEDS_ROS,
}
"""What each program prints after its name."""


def write_programs(folder: Path, path: Iterable[str]) -> None:
    """Write into `folder` the programs that no folder of `path` has. Raises OSError.

    It belongs at the end of PATH, so that a program that is installed later is found first.
    """
    folders = join_entries(path)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in ABSENT.items():
        if shutil.which(name, path=folders) is None:
            script = f"#!/bin/sh\necho {shlex.quote(f'{name} {text}')} >&2\nexit {_COMMAND_NOT_FOUND}\n"
            (folder / name).write_text(script, encoding="utf-8")
            (folder / name).chmod(0o755)
