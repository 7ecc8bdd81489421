"""Finds the files to check: the workspace's own, a folder, or one file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.errors import SubmissionError
from tutor.invocation import command
from tutor.judge.submission import Submission
from tutor.workspace.layout import Workspace, is_launch_file


def find_submission(lesson: Lesson, path: Path | None, workspace: Workspace | None) -> Submission:
    """The files to check for `lesson`.

    `path` is a folder that holds files of the exercise's names (or a workspace), or one file: it stands for the
    exercise's file of the same name, else for the first one; the exercise's other files are looked for beside it.
    Without `path`, the workspace's own files. Raises SubmissionError, which says in one line what is missing.
    """
    if path is None:
        return _workspace_submission(lesson, workspace)
    path = Path(os.path.abspath(path.expanduser()))
    if path.is_dir():
        if not os.access(path, os.R_OK | os.X_OK):
            raise SubmissionError(f"cannot read the folder {path}: permission denied")
        if Workspace(path).exists:
            return _workspace_submission(lesson, Workspace(path))
        return _submission(lesson, {file.name: path / file.name for file in lesson.files})
    if not path.exists():
        raise SubmissionError(f"there is no file or folder {path}{_similar(path.name, path.parent)}")
    names = [file.name for file in lesson.files]
    if path.is_file() and path.suffix.lower() not in _suffixes(names):
        raise SubmissionError(f"{path} is not a Python file; {lesson.id} is judged by {' and '.join(names)}")
    stands_for = path.name if path.name in names else names[0]
    return _submission(lesson, {name: path if name == stands_for else path.parent / name for name in names})


def _suffixes(names: Iterable[str]) -> tuple[str, ...]:
    """Those that a file may have which stands for one of these: a program may have none at all."""
    more = (".xml", ".yaml", ".yml") if any(map(is_launch_file, names)) else ()
    return ".py", "", *more


def is_started(lesson: Lesson, path: Path | None, workspace: Workspace | None) -> bool:
    """Whether any file of `lesson` is where `find_submission` looks for it. `path`, if given, is a folder."""
    if path is not None and not Workspace(path).exists:
        return any((path / file.name).exists() for file in lesson.files)
    home = workspace if path is None else Workspace(path)
    return home is not None and any(home.path_of(file.name).exists() for file in lesson.files)


def is_own(submission: Submission, workspace: Workspace) -> bool:
    """Whether `submission` is made of the workspace's own files, however they were named to us."""
    return workspace.exists and all(
        os.path.realpath(path) == os.path.realpath(workspace.path_of(name)) for name, path in submission.files.items()
    )


def solution(lesson: Lesson) -> Submission:
    """Our own answer, as a submission."""
    return Submission(lesson.id, {file.name: file.solution for file in lesson.files})


def _workspace_submission(lesson: Lesson, workspace: Workspace | None) -> Submission:
    if workspace is None or not workspace.exists:
        where = "here" if workspace is None else f"at {workspace.root}"
        raise SubmissionError(
            f"there is no workspace {where} yet: `{command('start', lesson.id)}` creates it, "
            f"or name the file or folder to check"
        )
    return _submission(lesson, {file.name: workspace.path_of(file.name) for file in lesson.files}, workspace)


def _submission(lesson: Lesson, places: dict[str, Path], workspace: Workspace | None = None) -> Submission:
    present = {name: place for name, place in places.items() if os.path.lexists(place)}
    for file in lesson.files:
        if file.required and file.name not in present:
            raise SubmissionError(_missing(lesson, file, places[file.name], workspace))
    for place in present.values():
        _require_readable(place)
    return Submission(lesson.id, present)


def _missing(lesson: Lesson, file: LessonFile, place: Path, workspace: Workspace | None) -> str:
    similar = _similar(file.name, place.parent, known=(other.name for other in lesson.files))
    if workspace is not None:
        advice = similar or f"; `{command('start', lesson.id)}` puts the skeleton there"
        return f"{lesson.id} needs {file.name}, and {place} is not there{advice}"
    if not similar and not any(place.parent.iterdir()):
        return f"{lesson.id} needs {file.name}, but the folder {place.parent} is empty"
    return f"{lesson.id} needs {file.name}, and it is not in {place.parent}{similar}"


def _similar(name: str, folder: Path, known: Iterable[str] = ()) -> str:
    """What may have been meant: a file of a similar name beside, or one of this name a folder or two below."""
    if not folder.is_dir():
        return ""
    try:
        beside = sorted(file.name for file in folder.glob("*.py") if file.name not in set(known))
        by_lower_case = {other.lower(): other for other in beside}
        near = get_close_matches(name.lower(), by_lower_case, n=1, cutoff=0.6)
        if near:
            return f" (found {by_lower_case[near[0]]} there: give it as PATH, or rename it to {name})"
        below = next(
            (place for pattern in (f"*/{name}", f"*/*/{name}") for place in sorted(folder.glob(pattern))), None
        )
    except OSError:
        return ""
    return f" (found it in {below.parent}: give that folder)" if below else ""


def _require_readable(place: Path) -> None:
    if place.is_dir():
        raise SubmissionError(f"{place} is a folder, not a Python file")
    if not place.exists():
        raise SubmissionError(f"{place} is a link to a file that is not there")
    if not place.is_file():
        raise SubmissionError(f"{place} is not a regular file")
    try:
        with place.open("rb"):
            pass
    except OSError as error:
        raise SubmissionError(f"cannot read {place}: {error.strerror}") from error
