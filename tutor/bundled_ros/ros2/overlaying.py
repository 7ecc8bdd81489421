"""Has the packages found that are there as sources only, for as long as this process lives."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from tutor import private_folders
from tutor.bundled_ros.ros2 import overlay
from tutor.errors import CommandError
from tutor.ros.environment import UNBUFFERED, UNBUFFERED_BY_US

_OVERLAY = "ROS_TUTOR_OVERLAY"


def restore_buffering() -> None:
    """Have what we start hold back its output as Python does, unless the user, or a check, wants it otherwise."""
    if os.environ.get(UNBUFFERED) == UNBUFFERED_BY_US:
        del os.environ[UNBUFFERED]


def overlay_workspace(near: Path) -> None:
    """Add the packages of the workspace around `near` (a file or folder), for us and for what we start.

    Raises CommandError where they cannot be read.
    """
    if Path(os.environ.get(_OVERLAY, "/nowhere")).is_dir():
        return  # of the `ros2` that started us
    try:
        folder = private_folders.until_exit("ros2-overlay")
        overlay.make_overlay(folder / "prefix", near, os.environ)
    except OSError as error:
        raise CommandError(f"the packages cannot be read: {error}") from error
    os.environ[_OVERLAY] = str(folder / "prefix")
    # What a launch file imports is searched for here, in this process.
    sys.path += [entry for entry in os.environ.get("PYTHONPATH", "").split(os.pathsep) if entry not in sys.path]
