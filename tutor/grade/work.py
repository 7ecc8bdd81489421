"""Finds the work of a class: for each learner and exercise the files to judge, or why there are none."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path, PurePosixPath

from tutor.content import Course, Lesson
from tutor.errors import UsageError
from tutor.grade.handed_in import HandedIn, Opener
from tutor.grade.layouts import Layouts
from tutor.grade.learners import Learner, with_unique_ids
from tutor.grade.roster import Roster
from tutor.grade.submission_files import digest_of, files_below, is_own_file
from tutor.judge.result import Lookup
from tutor.workspace.layout import path_beside

_MAX_LISTED = 20


@dataclass(frozen=True, slots=True)
class Work:
    """What one learner handed in for one exercise.

    `files`: from the path below the submission's folder to the file, everything that is needed to run it. `main`: the
    path, relative in the same way, of the folder or file to judge. `digest` identifies the files. If there is nothing
    to judge, `files` is empty, `missing` says why in a line, and `lookup` what was looked for. `fault`: why the files
    cannot be read on this machine; then nothing is known of them.
    """

    learner: Learner
    exercise: str
    files: Mapping[str, Path] = field(default_factory=dict)
    main: str = "."
    digest: str = ""
    missing: str = ""
    lookup: Lookup | None = None
    fault: str = ""


def find_work(
    submissions: Path,
    course: Course,
    scratch: Path,
    *,
    exercises: Sequence[str] = (),
    layout: str = "",
    roster: Roster | None = None,
    note: Callable[[str], None] = lambda text: None,
) -> list[Work]:
    """Return the work of every learner on every exercise, missing ones included, in the order of names and course.

    `submissions`: a folder or an archive. `scratch`: an empty folder for what archives hold; it must outlive the work.
    `exercises`: only these; by default, those that anybody has handed in. `layout`: a path in which {learner},
    {exercise}, {name}, {number} and {email} stand for parts of names, such as "{learner}/{exercise}"; by default, the
    layouts of Moodle, Canvas, Gradescope and git clones are recognised. `note` is told what was left out, in a line.
    Raises UsageError, UnknownExercise and StorageError.
    """
    chosen = {course.find(exercise).id for exercise in exercises}
    merged = Layouts(course, roster or Roster(), Opener(scratch), note).find(submissions, layout)
    if not merged:
        raise UsageError(f"there are no submissions in {submissions}")
    parts = [part for _, handed_in in merged for part in handed_in]
    lessons = [
        lesson
        for lesson in course.lessons
        if (lesson.id in chosen if chosen else any(_holds(part, lesson) for part in parts))
    ]
    only = len(lessons) == 1
    learners = with_unique_ids(learner for learner, _ in merged)
    return [
        replace(_find(handed_in, lesson, only=only), learner=learner)
        for learner, (_, handed_in) in zip(learners, merged, strict=True)
        for lesson in lessons or course.lessons
    ]


def _holds(handed: HandedIn, lesson: Lesson) -> bool:
    return handed.exercise == lesson.id or (not handed.exercise and next(_places(handed, lesson), None) is not None)


@dataclass(frozen=True, slots=True)
class _Place:
    """A folder, relative to the one that was handed in, and which files of the exercise are there, by name."""

    handed: HandedIn
    folder: str
    files: Mapping[str, Path]

    def rank(self, lesson: Lesson) -> tuple[bool, int, int, str]:
        """The best place comes first: in the exercise's own folder, with most files, the highest."""
        parts = PurePosixPath(self.folder).parts
        named = any(re.sub("[_-]", ".", part.lower()) == lesson.id for part in parts)
        return not named, -len(self.files), len(parts), self.folder


def _find(handed_in: Sequence[HandedIn], lesson: Lesson, *, only: bool) -> Work:
    """Return a learner's work on one exercise. `only`: no other exercise is graded, so that a lone file is for it."""
    learner = handed_in[0].learner
    handed_in = sorted(
        (part for part in handed_in if part.exercise in ("", lesson.id)), key=lambda part: not part.exercise
    )
    for handed in handed_in:
        if handed.fault:
            return Work(learner, lesson.id, fault=handed.fault)
    needed = [file.name for file in lesson.files if file.required]
    places = [place for handed in handed_in for place in sorted(_places(handed, lesson), key=lambda p: p.rank(lesson))]
    complete = [place for place in places if all(name in place.files for name in needed)]
    try:
        if complete:
            return _take(complete[0], lesson)
        if not places and len(needed) == 1 and (path := _lone_file(handed_in, lesson, only=only)):
            files = {needed[0]: path}
            return Work(learner, lesson.id, files, needed[0], digest_of(files))
    except OSError as error:
        return Work(learner, lesson.id, fault=f"{error.filename} cannot be read: {error.strerror}")
    best = max(places, key=lambda place: len(place.files), default=None)
    looked_for = tuple(name for name in needed if best is None or name not in best.files)
    there = [name for handed in handed_in for name in _all_names(handed)]
    problem = next((handed.problem for handed in handed_in if handed.problem), "")
    why = problem or _describe(looked_for, there)
    return Work(learner, lesson.id, missing=why, lookup=Lookup(looked_for, tuple(there[:_MAX_LISTED])))


def _places(handed: HandedIn, lesson: Lesson) -> Iterator[_Place]:
    """Yield where files of the exercise are."""
    wanted = [file.name for file in lesson.files]
    for folder, names in handed.names.items():
        if handed.folder is None:
            own = {name: handed.files[name] for name in wanted if name in handed.files}
        else:
            place = handed.folder / folder
            paths = {name: place / name for name in wanted if name in names}
            if paths:  # of another package, only beside the program
                paths |= {name: path_beside(place, name) for name in wanted if "/" in name}
            own = {name: path for name, path in paths.items() if is_own_file(path, handed.folder)}
        if own:
            yield _Place(handed, folder, own)


def _lone_file(handed_in: Sequence[HandedIn], lesson: Lesson, *, only: bool) -> Path | None:
    """Return the only program that was handed in as a single file, whatever its name, if it can only be for this."""
    files = [(handed, path) for handed in handed_in for path in handed.files.values()]
    if len(files) != 1 or len(handed_in) != 1:
        return None
    (handed, path) = files[0]
    return path if path.suffix == ".py" and (only or handed.exercise == lesson.id) else None


def _take(place: _Place, lesson: Lesson) -> Work:
    handed = place.handed
    if handed.folder is None:
        return Work(handed.learner, lesson.id, handed.files, ".", digest_of(handed.files))
    folder = handed.folder / place.folder
    base = _package_folder(folder, handed.folder)
    while not all(path.is_relative_to(base) for path in place.files.values()) and base != handed.folder:
        base = base.parent  # that holds both packages
    files = files_below(base, handed.folder)
    files |= {path.relative_to(base).as_posix(): path for path in place.files.values()}
    return Work(handed.learner, lesson.id, files, folder.relative_to(base).as_posix(), digest_of(files))


def _package_folder(folder: Path, top: Path) -> Path:
    """Return the ROS package that a folder is in, within `top`; the folder itself if it is in none."""
    for candidate in (folder, *folder.parents[:2]):
        if (candidate / "package.xml").is_file():
            return candidate
        if candidate == top:
            break
    return folder if not (folder / "__init__.py").is_file() or folder == top else folder.parent


def _all_names(handed: HandedIn) -> list[str]:
    return [str(PurePosixPath(folder, name)) for folder, names in handed.names.items() for name in names]


def _describe(looked_for: Sequence[str], there: Sequence[str]) -> str:
    if not there:
        return "nothing was handed in"
    names = {PurePosixPath(name).name.lower(): name for name in there}
    near = get_close_matches(looked_for[0].lower(), names, n=1, cutoff=0.6) if looked_for else []
    if near and PurePosixPath(names[near[0]]).name == looked_for[0]:
        return f"{names[near[0]]} is a link to what is not in this submission"
    hint = f" ({names[near[0]]} is there)" if near else ""
    return f"there is no {' and no '.join(looked_for)}{hint}"
