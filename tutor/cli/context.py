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
    """Load the bundled course, together with the lessons that `--lessons` names."""
    from tutor.content import load_course

    extra: Path | None = getattr(arguments, "lessons", None)
    if extra is not None and not (extra / "lessons").is_dir():
        raise UsageError(f"--lessons {extra}: it has no lessons/ folder")
    return load_course(extra)


def own_course(arguments: argparse.Namespace) -> Path | None:
    """Return the folder of the course that `--lessons` names."""
    extra: Path | None = getattr(arguments, "lessons", None)
    return extra


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
