"""Starts an exercise: creates the workspace if necessary, and puts the skeleton files in it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.content.cases import cases_of, read_report
from tutor.errors import StorageError, WorkspaceError
from tutor.workspace.drawn_cases import Drawn, skeleton_text
from tutor.workspace.layout import MARKER, Workspace
from tutor.workspace.placing_files import Placed, place_files
from tutor.workspace.saving import read_source

TEMPLATE = Path(__file__).parent / "template"
"""The initial content of a workspace."""

KEPT = Path(MARKER) / "handed-over"
"""Below it, the files of a system that was handed over are kept once another one takes their place."""


@dataclass(frozen=True, slots=True)
class Started:
    """The result of `start` or `start_in`."""

    files: Placed
    created_workspace: bool


def start(lesson: Lesson, workspace: Workspace, *, force: bool = False) -> Started:
    """Put the skeleton of `lesson` into the workspace, and create the parts of the workspace that are missing.

    Of a lesson with cases, one is drawn, and stays until `start_another`. Raises WorkspaceError, with nothing written,
    if a differing file is in the way and `force` is not set, and StorageError if the disk cannot be read or written.
    """
    created = not workspace.exists
    cases, drawn = cases_of(lesson), workspace.cases().read(lesson.id)
    if cases is not None and not drawn.current:
        drawn = drawn.draw(cases)
    skeletons = {workspace.path_of(file.name): _skeleton(lesson, file, drawn) for file in lesson.files}
    placed = place_files({**_missing_template(workspace), **skeletons}, force=force)
    try:
        (workspace.package / "launch").mkdir(exist_ok=True)
    except OSError as error:
        raise StorageError.of(f"make {workspace.package / 'launch'}", error) from error
    workspace.progress().change(lambda progress: progress.with_start(lesson.id))
    if cases is not None:
        workspace.cases().write(lesson.id, drawn)
    return Started(_select(placed, skeletons), created)


def start_another(lesson: Lesson, workspace: Workspace) -> Started:
    """Put another case of `lesson` into the workspace; all files of the one before are moved to a folder of ours.

    All, and not beside the new ones: else the files that differ would say where the fault is. Raises WorkspaceError for
    a lesson without cases, and StorageError.
    """
    if (cases := cases_of(lesson)) is None:
        raise WorkspaceError(f"there is only one of {lesson.id}")
    if not workspace.exists:
        return start(lesson, workspace)
    kept = _move_aside([workspace.path_of(file.name) for file in lesson.files], workspace.root / KEPT / lesson.id)
    file = workspace.cases()
    file.write(lesson.id, file.read(lesson.id).draw(cases))
    started = start(lesson, workspace)
    return Started(Placed(started.files.written, started.files.already_there, kept), started.created_workspace)


def _move_aside(paths: Sequence[Path], folder: Path) -> tuple[Path, ...]:
    """Move those of the files that are there into a new folder below `folder`, and return it, if there are any."""
    present = [path for path in paths if os.path.lexists(path)]
    if not present:
        return ()
    try:
        number = 1
        while os.path.lexists(kept := folder / str(number)):
            number += 1
        kept.mkdir(parents=True)
        for path in present:
            path.rename(kept / path.name)
    except OSError as error:
        raise StorageError.of(f"move {path} to {kept}", error) from error
    return (kept,)


def start_in(lesson: Lesson, folder: Path, *, force: bool = False) -> Started:
    """Put the bare skeleton files of `lesson` into any folder. Raises what `start` raises.

    Of a lesson with cases, it is the one that the report there names, or else one is drawn.
    """
    drawn = Drawn()
    if (cases := cases_of(lesson)) is not None:
        before = read_report(read_source(folder / cases.report) or "").case
        drawn = Drawn((before,)) if cases.find(before) is not None else drawn.draw(cases)
    skeletons = {folder / file.name: _skeleton(lesson, file, drawn) for file in lesson.files}
    return Started(place_files(skeletons, force=force), created_workspace=False)


def _skeleton(lesson: Lesson, file: LessonFile, drawn: Drawn) -> bytes:
    try:
        return skeleton_text(lesson, file, drawn).encode() if drawn.current else file.skeleton.read_bytes()
    except OSError as error:
        raise StorageError.of(f"read {file.skeleton}", error) from error


def _missing_template(workspace: Workspace) -> dict[Path, bytes]:
    """Return the template files that do not exist yet. An existing one belongs to the learner, whatever it contains."""
    files = {}
    for source in sorted(TEMPLATE.rglob("*")):
        if not source.is_file() or "__pycache__" in source.parts:
            continue
        name = source.relative_to(TEMPLATE)
        target = workspace.root / (".gitignore" if str(name) == "gitignore" else name)
        if not target.exists():
            files[target] = _read(source)
    return files


def _select(placed: Placed, wanted: Mapping[Path, bytes]) -> Placed:
    return Placed(
        written=tuple(path for path in placed.written if path in wanted),
        already_there=tuple(path for path in placed.already_there if path in wanted),
        backups=placed.backups,
    )


def _read(source: Path) -> bytes:
    try:
        return source.read_bytes()
    except OSError as error:
        raise StorageError.of(f"read {source}", error) from error
