"""Finds who handed in what: a folder or an archive for each learner, as the systems around a class lay them out."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from tutor.content import Course, Lesson
from tutor.errors import UsageError
from tutor.grade.archives import BadArchive, digest_of, files_below, is_archive, is_own_file, is_skipped, stem, unpack
from tutor.grade.learners import Learner, Roster, with_unique_ids
from tutor.judge.result import Lookup

_MOODLE = re.compile(r"(?P<name>.+?)_(?P<number>\d+)_assignsubmission_(?:file|onlinetext)_?(?P<file>.*)")
_CANVAS = re.compile(r"(?P<name>[^_]+)_(?:LATE_)?(?P<number>\d+)_\d+_(?P<file>.+)")
_CANVAS_AGAIN = re.compile(r"-\d+(?=\.[a-z]+$)")
_PLACEHOLDER = re.compile(r"\{(\w+)\}")
_FIELDS = ("learner", "exercise", "name", "number", "email")

_MAX_DEPTH = 6
_MAX_LISTED = 20


@dataclass(frozen=True, slots=True)
class Work:
    """What one learner handed in for one exercise.

    `files`: from the path below the submission's folder to the file, everything that is needed to run it. `main`: the
    path, relative in the same way, of the folder or file to judge. `digest` identifies the files. If there is nothing
    to judge, `files` is empty, `missing` says why in a line, and `lookup` what was looked for.
    """

    learner: Learner
    exercise: str
    files: Mapping[str, Path] = field(default_factory=dict)
    main: str = "."
    digest: str = ""
    missing: str = ""
    lookup: Lookup | None = None


@dataclass(frozen=True, slots=True)
class _HandedIn:
    """What one learner handed in: folders, or single files that were renamed by the system (`files`, by own name).

    `exercise`: the only one it is for; empty if it may be for any. `damaged`: why an archive could not be unpacked.
    """

    learner: Learner
    folder: Path | None = None
    files: Mapping[str, Path] = field(default_factory=dict)
    exercise: str = ""
    damaged: str = ""


def find_work(
    submissions: Path,
    course: Course,
    scratch: Path,
    *,
    exercises: Sequence[str] = (),
    layout: str = "",
    roster: Roster | None = None,
) -> list[Work]:
    """Return the work of every learner on every exercise, missing ones included, in the order of names and course.

    `submissions`: a folder or an archive. `scratch`: an empty folder for what archives hold; it must outlive the work.
    `exercises`: only these; by default, those that anybody has handed in. `layout`: a path in which {learner},
    {exercise}, {name}, {number} and {email} stand for parts of names, such as "{learner}/{exercise}"; by default, the
    layouts of Moodle, Canvas, Gradescope and git clones are recognised. Raises UsageError and UnknownExercise.
    """
    chosen = [course.find(exercise) for exercise in exercises]
    names = roster or Roster()
    root = _open(submissions, scratch)
    found = list(
        _by_layout(root, layout, names, scratch, course) if layout else _recognise(root, names, scratch, course)
    )
    found += [_HandedIn(learner) for learner in names.absent()]
    if not found:
        raise UsageError(f"there are no submissions in {submissions}")
    merged = _merge(found)
    lessons = chosen or [
        lesson for lesson in course.lessons if any(_holds(handed, lesson) for _, parts in merged for handed in parts)
    ]
    if not lessons:
        lessons = list(course.lessons)
    learners = with_unique_ids(learner for learner, _ in merged)
    return [
        replace(_work_of(parts, lesson, len(lessons) == 1), learner=learner)
        for learner, (_, parts) in zip(learners, merged, strict=True)
        for lesson in lessons
    ]


def _open(path: Path, scratch: Path) -> Path:
    if path.is_dir():
        return path
    if not is_archive(path):
        raise UsageError(
            f"{path} is neither a folder nor an archive (zip or tar)" if path.exists() else f"there is no {path}"
        )
    try:
        return _only_folder(_unpacked(path, scratch))
    except BadArchive as error:
        raise UsageError(f"{path} cannot be unpacked: {error}") from error


def _unpacked(archive: Path, scratch: Path) -> Path:
    folder = scratch / str(len(os.listdir(scratch)))
    folder.mkdir()
    unpack(archive, folder)
    return folder


def _only_folder(folder: Path) -> Path:
    """Return the folder that an archive holds if it holds nothing else, which would otherwise look like a learner."""
    entries = _visible(folder)
    inner = entries[0] if len(entries) == 1 and entries[0].is_dir() else None
    if inner is None or _MOODLE.fullmatch(inner.name):
        return folder
    return inner if any(entry.is_dir() or is_archive(entry) for entry in _visible(inner)) else folder


def _visible(folder: Path) -> list[Path]:
    try:
        return sorted(entry for entry in folder.iterdir() if not is_skipped(entry.name))
    except OSError as error:
        raise UsageError(f"cannot read {folder}: {error.strerror}") from error


# --- layouts ---


def _recognise(root: Path, roster: Roster, scratch: Path, course: Course) -> Iterator[_HandedIn]:
    entries = _visible(root)
    folders = [entry for entry in entries if entry.is_dir()]
    if folders and all(course.knows(folder.name) for folder in folders):
        yield from _by_layout(root, "{exercise}/{learner}", roster, scratch, course)
        return
    submitters = _gradescope_submitters(root)
    for entry in entries:
        if entry.is_dir() or is_archive(entry) or entry.suffix == ".py":
            yield _recognise_entry(entry, roster, scratch, submitters.get(entry.name, {}))


def _recognise_entry(entry: Path, roster: Roster, scratch: Path, submitter: Mapping[str, str]) -> _HandedIn:
    label = entry.name if entry.is_dir() else stem(entry)
    match = _MOODLE.fullmatch(entry.name)
    if match is None and not entry.is_dir():
        match = _CANVAS.fullmatch(entry.name)
    if match is not None:
        learner = roster.learner(match["name"], name=match["name"], number=match["number"])
    elif submitter:
        learner = roster.learner(label, **submitter)
    else:
        learner = roster.learner(label)
    name = _CANVAS_AGAIN.sub("", match["file"]) if match is not None and match["file"] else entry.name
    return _handed_in(learner, entry, name, scratch)


def _handed_in(learner: Learner, entry: Path, name: str, scratch: Path, exercise: str = "") -> _HandedIn:
    if entry.is_dir():
        return _HandedIn(learner, entry, exercise=exercise)
    if not is_archive(entry):
        return _HandedIn(learner, files={name: entry}, exercise=exercise)
    try:
        return _HandedIn(learner, _unpacked(entry, scratch), exercise=exercise)
    except BadArchive as error:
        return _HandedIn(learner, exercise=exercise, damaged=f"{name} cannot be unpacked: {error}")


def _gradescope_submitters(root: Path) -> dict[str, dict[str, str]]:
    """Return who handed in each folder of an export of Gradescope, by the folder's name."""
    import yaml

    try:
        document = yaml.safe_load((root / "submission_metadata.yml").read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return {}
    found: dict[str, dict[str, str]] = {}
    for folder, fields in document.items() if isinstance(document, dict) else ():
        submitters = fields.get(":submitters") if isinstance(fields, dict) else None
        first = submitters[0] if isinstance(submitters, list) and submitters else None
        if isinstance(first, dict):
            keys = {"name": ":name", "number": ":sid", "email": ":email"}
            found[str(folder)] = {key: str(first.get(source) or "") for key, source in keys.items()}
    return found


def _by_layout(root: Path, layout: str, roster: Roster, scratch: Path, course: Course) -> Iterator[_HandedIn]:
    patterns = [_pattern(part, layout) for part in layout.strip("/").split("/") if part]
    unknown = [name for name in _PLACEHOLDER.findall(layout) if name not in _FIELDS]
    if unknown or "{learner}" not in layout:
        what = f"{{{unknown[0]}}} is unknown" if unknown else "{learner} is missing"
        raise UsageError(f"--layout {layout}: {what}; it may have {', '.join(f'{{{name}}}' for name in _FIELDS)}")
    for path, fields in _matches(root, patterns, {}):
        exercise = fields.get("exercise", "")
        if exercise and not course.knows(exercise):
            continue
        details = {key: value for key, value in fields.items() if key in ("name", "number", "email")}
        learner = roster.learner(fields["learner"], **details)
        yield _handed_in(learner, path, path.name, scratch, course.find(exercise).id if exercise else "")


def _pattern(part: str, layout: str) -> re.Pattern[str]:
    names = set()
    text = ""
    position = 0
    for match in _PLACEHOLDER.finditer(part):
        name = match[1]
        text += re.escape(part[position : match.start()]) + (f"(?P={name})" if name in names else f"(?P<{name}>.+?)")
        names.add(name)
        position = match.end()
    try:
        return re.compile(text + re.escape(part[position:]).replace(r"\*", ".*"))
    except re.error as error:
        raise UsageError(f"--layout {layout}: it cannot be read") from error


def _matches(
    folder: Path, patterns: Sequence[re.Pattern[str]], fields: Mapping[str, str]
) -> Iterator[tuple[Path, dict[str, str]]]:
    for entry in _visible(folder):
        name = entry.name if entry.is_dir() else stem(entry)
        match = patterns[0].fullmatch(entry.name) or patterns[0].fullmatch(name)
        if match is None:
            continue
        known = {**fields, **match.groupdict()}
        if len(patterns) == 1:
            yield entry, known
        elif entry.is_dir():
            yield from _matches(entry, patterns[1:], known)


def _merge(found: Iterable[_HandedIn]) -> list[tuple[Learner, list[_HandedIn]]]:
    """Return what each learner handed in, in the order of their names."""
    by_learner: dict[tuple[str, str], list[_HandedIn]] = {}
    for handed in found:
        by_learner.setdefault((handed.learner.id, handed.learner.number), []).append(handed)
    merged = [(parts[0].learner, parts) for parts in by_learner.values()]
    return sorted(merged, key=lambda pair: (pair[0].name.casefold(), pair[0].id))


# --- the files of an exercise ---


def _holds(handed: _HandedIn, lesson: Lesson) -> bool:
    return handed.exercise == lesson.id or bool(_places(handed, lesson))


def _work_of(parts: Sequence[_HandedIn], lesson: Lesson, only: bool) -> Work:
    """Return a learner's work on one exercise. `only`: no other exercise is graded, so that a lone file is for it."""
    learner = parts[0].learner
    places = [(handed, place) for handed in parts for place in _places(handed, lesson)]
    needed = [file.name for file in lesson.files if file.required]
    for handed, place in places:
        if all(name in place[1] for name in needed):
            return _found(handed, lesson, place)
    best = max(places, key=lambda place: len(place[1][1]), default=None)
    lone = [handed for handed in parts if len(handed.files) == 1 and handed.folder is None]
    if best is None and len(lone) == len(parts) == 1 and (only or lone[0].exercise):
        path = next(iter(lone[0].files.values()))
        files = {lesson.files[0].name: path}
        return Work(learner, lesson.id, files, lesson.files[0].name, digest_of(files))
    damaged = next((handed.damaged for handed in parts if handed.damaged), "")
    found = set(best[1][1]) if best is not None else set()
    looked_for = tuple(name for name in needed if name not in found)
    there = [name for handed in parts for name in _list(handed)]
    why = damaged or _describe(looked_for, there)
    return Work(learner, lesson.id, missing=why, lookup=Lookup(looked_for, tuple(there[:_MAX_LISTED])))


def _describe(looked_for: Sequence[str], there: Sequence[str]) -> str:
    if not there:
        return "nothing was handed in"
    from difflib import get_close_matches

    names = {Path(name).name.lower(): name for name in there}
    near = get_close_matches(looked_for[0].lower(), names, n=1, cutoff=0.6) if looked_for else []
    hint = f" ({names[near[0]]} is there)" if near else ""
    return f"there is no {' and no '.join(looked_for)}{hint}"


def _list(handed: _HandedIn) -> list[str]:
    if handed.folder is None:
        return sorted(handed.files)
    names: list[str] = []
    for parent, folders, files in os.walk(handed.folder):
        folders[:] = sorted(name for name in folders if not is_skipped(name))
        names += (Path(parent, name).relative_to(handed.folder).as_posix() for name in sorted(files) if name[0] != ".")
        if len(names) > _MAX_LISTED:
            break
    return names


_Place = tuple[str, dict[str, Path]]
"""A folder, relative to the learner's, and which files of the exercise are there, by name."""


def _places(handed: _HandedIn, lesson: Lesson) -> list[_Place]:
    """Return where files of the exercise are, the best place first: in the exercise's own folder, then the highest."""
    if handed.exercise not in ("", lesson.id):
        return []
    names = [file.name for file in lesson.files]
    if handed.folder is None:
        own = {name: path for name, path in handed.files.items() if name in names}
        return [("", own)] if own else []
    places = []
    for parent, folders, _ in os.walk(handed.folder):
        relative = Path(parent).relative_to(handed.folder)
        folders[:] = (
            sorted(name for name in folders if not is_skipped(name)) if len(relative.parts) < _MAX_DEPTH else []
        )
        own = {name: Path(parent, name) for name in names if is_own_file(Path(parent, name), handed.folder)}
        if own:
            places.append((relative.as_posix(), own))

    def rank(place: _Place) -> tuple[bool, int, int, str]:
        parts = Path(place[0]).parts
        named = any(part.lower().replace("_", ".") == lesson.id for part in parts)
        return not named, -len(place[1]), len(parts), place[0]

    return sorted(places, key=rank)


def _found(handed: _HandedIn, lesson: Lesson, place: _Place) -> Work:
    relative, own = place
    if handed.folder is None:
        files = dict(handed.files)
        return Work(handed.learner, lesson.id, files, ".", digest_of(files))
    folder = handed.folder / relative
    base = _package_folder(folder, handed.folder)
    files = files_below(base, handed.folder)
    files |= {path.relative_to(base).as_posix(): path for path in own.values()}
    return Work(handed.learner, lesson.id, files, folder.relative_to(base).as_posix(), digest_of(files))


def _package_folder(folder: Path, top: Path) -> Path:
    """Return the ROS package that a folder is in, within `top`; the folder itself if it is in none."""
    for candidate in (folder, *folder.parents[:2]):
        if (candidate / "package.xml").is_file():
            return candidate
        if candidate == top:
            break
    return folder if not (folder / "__init__.py").is_file() or folder == top else folder.parent
