"""Make source-only packages discoverable for the lifetime of this process."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from tutor import private_folders
from tutor.bundled_ros.ros2 import overlay
from tutor.errors import CommandError
from tutor.ros.environment import UNBUFFERED, UNBUFFERED_BY_US
from tutor.ros.prefixes import entries

_OVERLAY_VARIABLE = "ROS_TUTOR_OVERLAY"


def restore_buffering() -> None:
    """Let child processes buffer their output as Python does by default, unless the user or a check turned that off."""
    if os.environ.get(UNBUFFERED) == UNBUFFERED_BY_US:
        del os.environ[UNBUFFERED]


def overlay_workspace(near: Path) -> None:
    """Add the packages of the workspace around `near` (a file or folder), for this process and its children.

    Raises CommandError if they cannot be read.
    """
    if Path(os.environ.get(_OVERLAY_VARIABLE, "/nowhere")).is_dir():
        return  # made by the `ros2` that started us
    try:
        folder = private_folders.create_until_exit("ros2-overlay")
        overlay.make_overlay(folder / "prefix", near, os.environ)
    except OSError as error:
        raise CommandError(f"the packages cannot be read: {error}") from error
    os.environ[_OVERLAY_VARIABLE] = str(folder / "prefix")
    # A launch file runs, and so imports modules, in this process.
    sys.path += [entry for entry in entries(os.environ, "PYTHONPATH") if entry not in sys.path]
