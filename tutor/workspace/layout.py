"""The location of the workspace, and of the files in it."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tutor.errors import WorkspaceError
from tutor.workspace.app_state import AppStateFile
from tutor.workspace.drawn_cases import DrawnCases
from tutor.workspace.last_checks import LastChecks
from tutor.workspace.progress_file import ProgressFile, to_stderr
from tutor.workspace.remembered_courses import RememberedCourses

MARKER = ".ros-tutor"
"""The subfolder that marks a folder as a workspace; it holds the progress and our other files."""

PACKAGE = "my_package"

DATA_SUFFIX = ".yaml"
"""Files with parameters, and with what is known of a launched system, are beside its launch file."""


@dataclass(frozen=True, slots=True)
class Workspace:
    """A learner's colcon workspace. `root` need not exist yet."""

    root: Path

    @property
    def exists(self) -> bool:
        """Whether `root` is a workspace, rather than just a folder, or nothing at all."""
        return (self.root / MARKER).is_dir()

    @property
    def package(self) -> Path:
        """The folder of the learner's ROS package."""
        return self.root / "src" / PACKAGE

    def path_of(self, name: str) -> Path:
        """Return where the exercise file `name` belongs: launch files, and what they read, in `launch/`.

        Others are in the Python package. A path, such as my_interfaces/package.xml, is one in `src`: it begins with
        another package.
        """
        if "/" in name:
            return self.root / "src" / name
        return self.package / ("launch" if is_launch_file(name) or name.endswith(DATA_SUFFIX) else PACKAGE) / name

    def progress(self, notify: Callable[[str], None] = to_stderr) -> ProgressFile:
        """Return the progress file; `notify` is called with one line if a damaged one had to be set aside."""
        return ProgressFile(self.root / MARKER / "progress.json", notify)

    def courses(self, notify: Callable[[str], None] = to_stderr) -> RememberedCourses:
        """Return the file of the courses started here; `notify` is called with one line if one of them is gone."""
        return RememberedCourses(self.root / MARKER / "courses.json", notify)

    def cases(self, notify: Callable[[str], None] = to_stderr) -> DrawnCases:
        """Return the file of the faults drawn here; `notify` is called with one line if a damaged one was set aside."""
        return DrawnCases(self.root / MARKER / "cases.json", notify)

    def app_state(self, notify: Callable[[str], None] = to_stderr) -> AppStateFile:
        """Return the app's state file; `notify` is called with one line if a damaged one had to be set aside."""
        return AppStateFile(self.root / MARKER / "app.json", notify)

    def last_checks(self, notify: Callable[[str], None] = to_stderr) -> LastChecks:
        """Return the last checks; `notify` is called with one line if a damaged file had to be set aside."""
        return LastChecks(self.root / MARKER / "last-checks", notify)


def path_beside(folder: Path, name: str) -> Path:
    """Return where the exercise file `name` is expected if the exercise's program is in `folder`.

    A path, which begins with another package, may also be beside the Python package that the folder is, as in `src`.
    """
    beside = folder.parent.parent / name
    return beside if "/" in name and not (folder / name).exists() and beside.exists() else folder / name


def is_launch_file(name: str) -> bool:
    """Whether an exercise's file is a launch file, judging by its name."""
    return name.endswith(("_launch.py", ".launch.py"))


def find_workspace(explicit: Path | None = None) -> Path:
    """Return the root of the workspace to use, which may not exist yet.

    In this order: `explicit`, `ROS_TUTOR_WORKSPACE`, the workspace that contains the current folder, `~/ros_tutor_ws`.
    Raises WorkspaceError if the home directory is unknown.
    """
    if explicit is not None:
        return _absolute(explicit)
    if named := os.environ.get("ROS_TUTOR_WORKSPACE"):
        return _absolute(Path(named))
    try:
        return _find_enclosing() or Path.home() / "ros_tutor_ws"
    except RuntimeError:
        raise WorkspaceError(
            "HOME is not set, and you have no home folder: name a folder with --workspace DIR"
        ) from None


def _find_enclosing() -> Path | None:
    try:
        here = Path.cwd()
    except FileNotFoundError:  # the current folder was deleted
        return None
    return next((folder for folder in (here, *here.parents) if Workspace(folder).exists), None)


def _absolute(path: Path) -> Path:
    return Path(os.path.abspath(path.expanduser()))
