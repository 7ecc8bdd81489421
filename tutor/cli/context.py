"""What most commands need first: the course and the workspace."""

from __future__ import annotations

import argparse
import os
from typing import TYPE_CHECKING

from tutor.cli import terminal
from tutor.errors import UsageError
from tutor.invocation import command

if TYPE_CHECKING:
    from pathlib import Path

    from tutor.content import Course
    from tutor.workspace import Progress, Workspace


def load_course(arguments: argparse.Namespace) -> Course:
    """The bundled course, and the one that `--lessons` names."""
    from tutor.content import load_course

    extra: Path | None = getattr(arguments, "lessons", None)
    if extra is not None and not (extra / "lessons").is_dir():
        raise UsageError(f"--lessons {extra}: there is no folder lessons in it")
    return load_course(extra)


def choose_workspace(arguments: argparse.Namespace) -> Workspace:
    """The workspace to use, whether it exists or not. Raises UsageError where one is named that can never be one."""
    found = choose_any_workspace(arguments)
    named = getattr(arguments, "workspace", None) is not None or os.environ.get("ROS_TUTOR_WORKSPACE")
    if named and not found.exists and (why := _cannot_be_made(found.root)):
        raise UsageError(f"{found.root} cannot be your workspace: {why}; name another folder with --workspace DIR")
    return found


def choose_any_workspace(arguments: argparse.Namespace) -> Workspace:
    """The workspace as `place` gives it, even where it can never be one."""
    from tutor.workspace import Workspace, find_workspace

    return Workspace(find_workspace(getattr(arguments, "workspace", None)))


def _cannot_be_made(root: Path) -> str:
    """Why no workspace can be made at `root`; empty where it can."""
    import tempfile

    nearest = next(folder for folder in (root, *root.parents) if os.path.lexists(folder))
    if not nearest.is_dir():
        return "it is a file" if nearest == root else f"{nearest} is a file"
    try:
        with tempfile.NamedTemporaryFile(dir=nearest, prefix=".ros-tutor-"):  # permissions say nothing about /proc
            return ""
    except OSError as error:
        return f"nothing can be written to {nearest} ({error.strerror})"


def require_workspace(arguments: argparse.Namespace) -> Workspace:
    """The workspace to use. It may not exist yet, unless it was named: then UsageError says that it is not one."""
    found = choose_workspace(arguments)
    if getattr(arguments, "workspace", None) is not None and not found.exists:
        make = command("start", "i1.1", "--workspace", found.root)
        raise UsageError(f"{found.root} is not a workspace; `{make}` makes it one")
    return found


def read_progress(workspace: Workspace) -> Progress:
    """The progress in `workspace`; an empty one where there is no workspace."""
    from tutor.workspace import Progress

    return workspace.progress(terminal.say).read() if workspace.exists else Progress()


def display_path(path: Path) -> str:
    """A path as people write it: relative to the current folder or to the home, where that is shorter."""
    from pathlib import Path

    texts = [str(path)]
    for start, prefix in ((Path.cwd, ""), (Path.home, "~/")):
        try:
            if path.is_relative_to(start()):
                texts.append(prefix + str(path.relative_to(start())))
        except (OSError, RuntimeError):
            continue
    return min(texts, key=len)
