"""Finds the files to check: the workspace's own, those in a folder, or a single file."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable
from difflib import get_close_matches
from pathlib import Path

from tutor.content import Lesson, LessonFile
from tutor.errors import SubmissionError
from tutor.invocation import command
from tutor.judge.result import CriterionResult, ExerciseResult, Lookup
from tutor.judge.submission import Submission
from tutor.judge.verdict import Status, Verdict
from tutor.workspace.layout import Workspace, is_launch_file, path_beside

NOT_STARTED = "not started"
_MAX_LISTED = 20


def find_submission(lesson: Lesson, path: Path | None, workspace: Workspace | None) -> Submission:
    """Find the files to check for `lesson`; by default, the workspace's own.

    `path` is a workspace, a folder with files named as in the exercise, or a single file. The latter stands for the
    exercise's file of the same name, or else for its first file; the other files are looked for beside it. Raises
    SubmissionError, which says in one line what is missing.
    """
    if path is None:
        return _workspace_submission(lesson, workspace)
    path = _absolute(path)
    if path.is_dir() and not os.access(path, os.R_OK | os.X_OK):
        raise SubmissionError(f"cannot read the folder {path}: permission denied")
    if Workspace(path).exists:
        return _workspace_submission(lesson, Workspace(path))
    if not path.exists():
        raise SubmissionError(f"there is no file or folder {path}{_suggest_similar(path.name, path.parent)}")
    names = [file.name for file in lesson.files]
    if path.is_file() and path.suffix.lower() not in _allowed_suffixes(names):
        raise SubmissionError(f"{path} is not a Python file; {lesson.id} is judged by {' and '.join(names)}")
    return _make_submission(lesson, _places(lesson, path, workspace))


def look_up(lesson: Lesson, path: Path | None, workspace: Workspace | None) -> Lookup | None:
    """Return which files `find_submission` looks for and does not find, and what there is; None if it misses none."""
    places = _places(lesson, None if path is None else _absolute(path), workspace)
    needed = [places[file.name] for file in lesson.files if file.required and file.name in places]
    missing = [place for place in needed if not os.path.lexists(place)]
    if not missing:
        return None
    return Lookup(tuple(map(str, missing)), tuple(_list_folder(missing[0].parent)))


def missing_result(lesson: Lesson, status: Status, why: str, lookup: Lookup | None) -> ExerciseResult:
    """Return the result of an exercise whose files are missing: each of its criteria has this status."""
    names = ", ".join(file.name for file in lesson.files if file.required)
    hint = f"`{command('start', lesson.id)}` puts the skeleton into the workspace" if why == NOT_STARTED else ""
    verdict = Verdict(status, expected=names, cause=why, step=hint)
    return ExerciseResult(
        id=lesson.id,
        title=lesson.title,
        submission=(),
        criteria=tuple(CriterionResult(c.id, c.text, c.bonus, verdict, 0.0) for c in lesson.criteria),
        duration_s=0.0,
        lookup=lookup,
    )


def _list_folder(folder: Path) -> list[str]:
    """Return the first names in a folder, with a "/" after those of folders; none if it cannot be read."""
    try:
        names = sorted(entry.name + "/" * entry.is_dir() for entry in os.scandir(folder))
    except OSError:
        return []
    return [name for name in names if not name.startswith((".", "__"))][:_MAX_LISTED]


def _places(lesson: Lesson, path: Path | None, workspace: Workspace | None) -> dict[str, Path]:
    """Return where each file of `lesson` is expected; empty if there is neither a path nor a workspace."""
    names = [file.name for file in lesson.files]
    home = workspace if path is None else Workspace(path)
    if home is None:
        return {}
    if path is None or home.exists:
        return {name: home.path_of(name) for name in names}
    if path.is_dir():
        return {name: path_beside(path, name) for name in names}
    represented = path.name if path.name in names else names[0]
    return {name: path if name == represented else path_beside(path.parent, name) for name in names}


def _absolute(path: Path) -> Path:
    return Path(os.path.abspath(path.expanduser()))


def _allowed_suffixes(names: Iterable[str]) -> tuple[str, ...]:
    """Return the suffixes allowed for a file that stands for one of `names`: a program may have none at all."""
    launch_suffixes = (".xml", ".yaml", ".yml") if any(map(is_launch_file, names)) else ()
    return ".py", "", *launch_suffixes


def is_started(lesson: Lesson, path: Path | None, workspace: Workspace | None) -> bool:
    """Whether any file of `lesson` exists where `find_submission` looks for it. `path`, if given, is a folder."""
    if path is not None and not Workspace(path).exists:
        return any((path / file.name).exists() for file in lesson.files)
    home = workspace if path is None else Workspace(path)
    return home is not None and any(home.path_of(file.name).exists() for file in lesson.files)


def is_own(submission: Submission, workspace: Workspace) -> bool:
    """Whether `submission` consists of the workspace's own files, by whatever paths they were given."""
    return workspace.exists and all(
        os.path.realpath(path) == os.path.realpath(workspace.path_of(name)) for name, path in submission.files.items()
    )


def solution(lesson: Lesson) -> Submission:
    """Return our solution as a submission."""
    return Submission(lesson.id, {file.name: file.solution for file in lesson.files})


def _workspace_submission(lesson: Lesson, workspace: Workspace | None) -> Submission:
    if workspace is None or not workspace.exists:
        where = "here" if workspace is None else f"at {workspace.root}"
        raise SubmissionError(
            f"there is no workspace {where} yet: `{command('start', lesson.id)}` creates it, "
            f"or name the file or folder to check"
        )
    return _make_submission(lesson, _places(lesson, None, workspace), workspace)


def _make_submission(lesson: Lesson, places: dict[str, Path], workspace: Workspace | None = None) -> Submission:
    present = {name: place for name, place in places.items() if os.path.lexists(place)}
    for file in lesson.files:
        if file.required and file.name not in present:
            raise SubmissionError(_describe_missing(lesson, file, places[file.name], workspace))
    for place in present.values():
        _require_readable(place)
    return Submission(lesson.id, present)


def _describe_missing(lesson: Lesson, file: LessonFile, place: Path, workspace: Workspace | None) -> str:
    similar = _suggest_similar(file.name, place.parent, known=[other.name for other in lesson.files])
    if workspace is not None:
        advice = similar or f"; `{command('start', lesson.id)}` puts the skeleton there"
        return f"{lesson.id} needs {file.name}, but {place} does not exist{advice}"
    if not similar and place.parent.is_dir() and not any(place.parent.iterdir()):
        return f"{lesson.id} needs {file.name}, but the folder {place.parent} is empty"
    return f"{lesson.id} needs {file.name}, but it is not in {place.parent}{similar}"


def _suggest_similar(name: str, folder: Path, known: Collection[str] = ()) -> str:
    """Suggest what was probably meant: a similarly named file in `folder` (none of `known`), or one further below."""
    if not folder.is_dir():
        return ""
    try:
        beside = sorted(file.name for file in folder.glob("*.py") if file.name not in known)
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
        raise SubmissionError(f"{place} is a link to a file that does not exist")
    if not place.is_file():
        raise SubmissionError(f"{place} is not a regular file")
    try:
        with place.open("rb"):
            pass
    except OSError as error:
        raise SubmissionError(f"cannot read {place}: {error.strerror}") from error
