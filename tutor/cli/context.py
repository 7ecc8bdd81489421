"""What most commands need first: the course and the workspace."""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from typing import TYPE_CHECKING

from tutor.cli import terminal
from tutor.errors import UsageError
from tutor.invocation import command

if TYPE_CHECKING:
    from pathlib import Path

    from tutor.content import Course
    from tutor.content.courses import Courses
    from tutor.workspace import Progress, Workspace


LESSONS_VARIABLE = "ROS_TUTOR_LESSONS"


def load_course(arguments: argparse.Namespace) -> Course:
    """Load the bundled course, and those chosen beside it."""
    return load(choose_courses(arguments))


def load(courses: Courses) -> Course:
    """Load the bundled course, and these beside it or instead of it."""
    from tutor.content import load_course

    return load_course(courses.folders, only=courses.only)


def choose_courses(arguments: argparse.Namespace) -> Courses:
    """Return the courses to use: those named, or else those that the workspace remembers. Raises UsageError."""
    from tutor.content.courses import Courses
    from tutor.errors import WorkspaceError

    only = getattr(arguments, "only", False)
    if (named := named_courses(arguments)) is not None:
        return named
    try:
        remembered = choose_any_workspace(arguments).courses(terminal.say).read()
    except WorkspaceError:  # there is no home
        return Courses()
    if only and not remembered.folders:
        raise UsageError("--only leaves out the exercises of ros-tutor itself: name a course with --lessons COURSE")
    return replace(remembered, only=only or remembered.only)


def only_folder(courses: Courses) -> Path | None:
    """Return the folder of the course beside the bundled one, if any. Raises UsageError for several."""
    if len(courses.folders) > 1:
        raise UsageError("this takes one course at a time: name it with --lessons COURSE")
    return courses.folders[0] if courses.folders else None


def named_courses(arguments: argparse.Namespace) -> Courses | None:
    """Return the courses that `--lessons` names, or else ROS_TUTOR_LESSONS; None if neither is set."""
    from tutor.content.courses import Courses

    given: list[str] | None = getattr(arguments, "lessons", None)
    if given is None and (listed := os.environ.get(LESSONS_VARIABLE)) is not None:
        given = [text for text in listed.split(os.pathsep) if text]
    return None if given is None else Courses.find(given, only=getattr(arguments, "only", False))


def own_courses(arguments: argparse.Namespace) -> Courses:
    """Return the courses of an author: those named, or else the one in the current folder."""
    from pathlib import Path

    from tutor.content.courses import MANIFEST, Courses

    if (named := named_courses(arguments)) is not None:
        return named
    here = Path.cwd()
    return Courses.find([here]) if (here / MANIFEST).is_file() and (here / "lessons").is_dir() else Courses()


def choose_workspace(arguments: argparse.Namespace) -> Workspace:
    """Return the workspace to use, which may not exist yet. Raises UsageError if a named one cannot be created."""
    found = choose_any_workspace(arguments)
    named = getattr(arguments, "workspace", None) is not None or os.environ.get("ROS_TUTOR_WORKSPACE")
    if named and not found.exists and (why := _why_not_creatable(found.root)):
        raise UsageError(f"{found.root} cannot be your workspace: {why}; name another folder with --workspace DIR")
    return found


def choose_any_workspace(arguments: argparse.Namespace) -> Workspace:
    """Return the workspace that `find_workspace` finds, even if it cannot be created."""
    from tutor.workspace import Workspace, find_workspace

    return Workspace(find_workspace(getattr(arguments, "workspace", None)))


def _why_not_creatable(root: Path) -> str:
    """Return why no workspace can be created at `root`; empty if it can."""
    import tempfile

    nearest = next(folder for folder in (root, *root.parents) if os.path.lexists(folder))
    if not nearest.is_dir():
        return "it is a file" if nearest == root else f"{nearest} is a file"
    try:
        # Try it: permission bits alone are misleading, for example in /proc.
        with tempfile.NamedTemporaryFile(dir=nearest, prefix=".ros-tutor-"):
            return ""
    except OSError as error:
        return f"nothing can be written to {nearest} ({error.strerror})"


def require_workspace(arguments: argparse.Namespace) -> Workspace:
    """Return the workspace to use, which may not exist yet. Raises UsageError if `--workspace` names a missing one."""
    found = choose_workspace(arguments)
    if getattr(arguments, "workspace", None) is not None and not found.exists:
        create = command("start", "i1.1", "--workspace", found.root)
        raise UsageError(f"{found.root} is not a workspace; `{create}` makes it one")
    return found


def read_progress(workspace: Workspace) -> Progress:
    """Return the progress saved in `workspace`; empty if the workspace does not exist."""
    from tutor.workspace import Progress

    return workspace.progress(terminal.say).read() if workspace.exists else Progress()


def display_path(path: Path) -> str:
    """Return a path as people write it: relative to the current folder or the home directory, if that is shorter."""
    from pathlib import Path

    texts = [str(path)]
    for start, prefix in ((Path.cwd, ""), (Path.home, "~/")):
        try:
            if path.is_relative_to(start()):
                texts.append(prefix + str(path.relative_to(start())))
        except (OSError, RuntimeError):
            continue
    return min(texts, key=len)
