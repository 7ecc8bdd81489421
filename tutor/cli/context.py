"""What most commands need first: the course and the workspace."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from tutor.cli import terminal
from tutor.cli.errors import UsageError

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


def place(arguments: argparse.Namespace) -> Workspace:
    """The workspace to use, whether it exists or not."""
    from tutor.workspace import Workspace, find_workspace

    return Workspace(find_workspace(getattr(arguments, "workspace", None)))


def workspace(arguments: argparse.Namespace) -> Workspace:
    """The workspace to use. It may not exist yet, unless it was named: then UsageError says that it is none."""
    found = place(arguments)
    if getattr(arguments, "workspace", None) is not None and not found.exists:
        raise UsageError(f"{found.root} is no workspace; `ros-tutor start i1.1 --workspace {found.root}` makes it one")
    return found


def read_progress(workspace: Workspace) -> Progress:
    """The progress in `workspace`; an empty one where there is no workspace."""
    from tutor.workspace import Progress

    return workspace.progress(terminal.say).read() if workspace.exists else Progress()


def shown(path: Path) -> str:
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
