"""Finds what each learner handed in, as the systems around a class lay it out."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from tutor.content import Course
from tutor.grade.archives import is_archive, is_skipped, stem
from tutor.grade.handed_in import HandedIn, Opener
from tutor.grade.layout_pattern import LayoutPattern, visible
from tutor.grade.learners import Learner
from tutor.grade.roster import Roster

_MOODLE = re.compile(
    r"(?P<name>.+?)_(?P<participant>\d+)_assignsubmission_(?:file|onlinetext)_?(?P<file>.*)", re.DOTALL
)
_CANVAS = re.compile(r"(?P<name>[^_]+)_(?:LATE_)?(?P<number>\d+)_\d+_(?P<file>.+)", re.DOTALL)
_CANVAS_AGAIN = re.compile(r"-(?P<time>\d+)(?=(?:\.\w+)+$)")
_GRADESCOPE = "submission_metadata.yml"
_SUBMITTER = {"name": "name", "number": "sid", "email": "email"}
_TEACHERS = (".csv", ".toml", ".md", ".yml", ".json", ".html")
"""Files that may lie beside the submissions and need not be told of."""

_MAX_NOTED = 10
_ASTRAY = "{} is a link to what is not in this submission"

Note = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Layouts:
    """Finds what each learner handed in. `note` is told, in one line, what was left out."""

    course: Course
    roster: Roster
    opener: Opener
    note: Note = lambda text: None

    def find(self, submissions: Path, layout: str) -> list[tuple[Learner, list[HandedIn]]]:
        """Return each learner with all that they handed in, by name; those who only the roster knows included.

        `submissions`: a folder or an archive. `layout`: see `LayoutPattern`; if empty, it is recognised. Raises
        UsageError.
        """
        root, name = self.opener.open_class(submissions)
        if layout:
            found = list(self._by_pattern(root, LayoutPattern(layout, self.course)))
        else:
            found = list(self._recognise(*(self._only_folder(root, name) if submissions.is_file() else (root, name))))
        return _merge([*found, *(HandedIn(learner) for learner in self.roster.absent())])

    def _by_pattern(self, root: Path, pattern: LayoutPattern) -> Iterator[HandedIn]:
        taken = set()
        for match in pattern.match(root):
            fields = dict(match.fields)
            named = fields.pop("exercise", "")
            exercise = self._exercise(named)
            if named and not exercise and not pattern.learner_comes_first:
                continue
            taken.add(match.path.relative_to(root).parts[0])
            learner = self.roster.learner(fields.pop("learner"), **fields)
            if _leads_astray(match.path, match.path.parent, is_class=match.path.parent == root):
                yield HandedIn(learner, exercise=exercise, problem=_ASTRAY.format(match.path.name))
            elif match.whole:
                yield from self.opener.open(learner, match.path, exercise=exercise)
            else:
                below = [entry.name for entry in visible(match.path)] if match.path.is_dir() else [match.path.name]
                yield HandedIn(learner, exercise=exercise, names={".": below})
        self._note_left_out(entry.name for entry in visible(root) if entry.name not in taken)

    def _recognise(self, root: Path, name: str) -> Iterator[HandedIn]:
        entries = visible(root)
        exercises = [entry for entry in entries if entry.is_dir() and self._exercise(entry.name)]
        if self._is_one_learners(entries, exercises):
            yield from self.opener.open(self.roster.learner(name), root)
        elif exercises:
            for entry in exercises:
                yield from self._recognise_entries(entry, self._exercise(entry.name))
            self._note_left_out(entry.name for entry in entries if entry not in exercises)
        else:
            yield from self._recognise_entries(root, "")

    def _only_folder(self, root: Path, name: str) -> tuple[Path, str]:
        """Return the folder that a class consists of, if there is nothing else: archives often hold one."""
        entries = visible(root)
        inner = entries[0] if len(entries) == 1 and entries[0].is_dir() else None
        if inner is None or _MOODLE.fullmatch(inner.name) or self._exercise(inner.name):
            return root, name
        holds = visible(inner)
        exercises = [entry for entry in holds if entry.is_dir() and self._exercise(entry.name)]
        if self._is_one_learners(holds, exercises) or not any(entry.is_dir() or is_archive(entry) for entry in holds):
            return root, name
        return inner, inner.name

    def _is_one_learners(self, entries: Sequence[Path], exercises: Sequence[Path]) -> bool:
        """Whether these are in the folder of one learner, rather than of a class."""
        names = {file.name for lesson in self.course.lessons for file in lesson.files}
        folders = [entry for entry in entries if entry.is_dir()]
        if any(entry.name == "package.xml" for entry in entries):
            return True
        if any(entry.name == "src" and any(entry.glob("*/package.xml")) for entry in folders):
            return True
        if not folders:
            from_a_system = any(
                is_archive(entry) or _MOODLE.fullmatch(entry.name) or _CANVAS.fullmatch(entry.name) for entry in entries
            )
            return not from_a_system and any(entry.name in names for entry in entries)
        inside = [entry for folder in exercises for entry in visible(folder)]
        return any(entry.name in names for entry in inside) and not any(
            entry.is_dir() or is_archive(entry) for entry in inside
        )

    def _recognise_entries(self, folder: Path, exercise: str) -> Iterator[HandedIn]:
        submitters = _read_submitters(folder / _GRADESCOPE)
        left_out = []
        for entry in visible(folder):
            learners = list(self._learners(entry, submitters.get(entry.name, ())))
            for learner, name in learners:
                if _leads_astray(entry, folder, is_class=True):
                    yield HandedIn(learner, exercise=exercise, problem=_ASTRAY.format(entry.name))
                else:
                    yield from self.opener.open(learner, entry, name=name, exercise=exercise)
            if not learners and entry.suffix.lower() not in _TEACHERS:
                left_out.append(entry.name)
        self._note_left_out(left_out)

    def _learners(self, entry: Path, submitters: Sequence[Mapping[str, str]]) -> Iterator[tuple[Learner, str]]:
        """Yield who handed in an entry of the class's folder, and the entry's own name; nothing if nobody did."""
        is_folder = entry.is_dir()
        label = entry.name if is_folder else stem(entry)
        if moodle := _MOODLE.fullmatch(entry.name):
            learner = self.roster.learner(moodle["name"], name=moodle["name"], participant=moodle["participant"])
            yield learner, moodle["file"] or entry.name
        elif not is_folder and (canvas := _CANVAS.fullmatch(entry.name)):
            learner = self.roster.learner(canvas["name"], name=canvas["name"], number=canvas["number"])
            yield learner, canvas["file"]
        elif submitters:
            for submitter in submitters:
                known = submitter["number"] or submitter["email"] or submitter["name"] or label
                yield self.roster.learner(known, **submitter), entry.name
        elif (is_folder and not is_skipped(entry.name.lstrip("."))) or is_archive(entry) or entry.suffix == ".py":
            yield self.roster.learner(label), entry.name

    def _exercise(self, text: str) -> str:
        """Return the id of an exercise, which may be written as i1.1, i1_1 or i1-1; empty if this is none."""
        name = text.replace("-", ".")
        return self.course.find(name).id if self.course.knows(name) else ""

    def _note_left_out(self, names: Iterable[str]) -> None:
        if listed := list(names):
            more = f" and {len(listed) - _MAX_NOTED} more" if len(listed) > _MAX_NOTED else ""
            self.note(f"left out, as nobody's submission: {', '.join(listed[:_MAX_NOTED])}{more}")


def _leads_astray(path: Path, folder: Path, *, is_class: bool) -> bool:
    """Whether a path in `folder` is a link to another learner's files, or out of a learner's own folder."""
    if not path.is_symlink():
        return False
    try:
        return path.resolve().is_relative_to(folder.resolve()) is is_class
    except (OSError, RuntimeError):
        return True


def _read_submitters(file: Path) -> dict[str, list[dict[str, str]]]:
    """Return who handed in each folder of an export of Gradescope, by the folder's name."""
    import yaml

    loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)  # all scalars are text, as a number with leading zeros is
    try:
        document = yaml.load(file.read_text(encoding="utf-8"), Loader=loader)
    except (OSError, ValueError, RecursionError, yaml.YAMLError):
        return {}
    found: dict[str, list[dict[str, str]]] = {}
    for folder, fields in document.items() if isinstance(document, dict) else ():
        submitters = fields.get(":submitters") if isinstance(fields, dict) else None
        found[str(folder)] = [
            {key: str(submitter.get(f":{source}") or "") for key, source in _SUBMITTER.items()}
            for submitter in (submitters if isinstance(submitters, list) else ())
            if isinstance(submitter, dict)
        ]
    return found


def _merge(found: Iterable[HandedIn]) -> list[tuple[Learner, list[HandedIn]]]:
    """Return what each learner handed in, in the order of their names.

    Moodle gives a learner another number in each assignment, so a number only tells apart those who handed in something
    for the same one under the same name.
    """
    by_id: dict[str, list[HandedIn]] = {}
    for handed in found:
        by_id.setdefault(handed.learner.id, []).append(handed)
    merged = []
    for parts in by_id.values():
        numbers: dict[str, set[str]] = {}
        for handed in parts:
            numbers.setdefault(handed.exercise, set()).add(handed.learner.number)
        apart = any(len(known) > 1 for known in numbers.values())
        for number in sorted({handed.learner.number for handed in parts}) if apart else [None]:
            own = [handed for handed in parts if number is None or handed.learner.number == number]
            merged.append((own[0].learner, _join_files(own)))
    return sorted(merged, key=lambda pair: (pair[0].name.casefold(), pair[0].id, pair[0].number))


def _join_files(parts: Iterable[HandedIn]) -> list[HandedIn]:
    """Put the single files of a learner together, as they need each other; the latest of several of the same name."""
    joined: list[HandedIn] = []
    latest: dict[tuple[str, str], int] = {}
    for handed in parts:
        if not handed.files:
            joined.append(handed)
            continue
        (name, path), *_ = handed.files.items()
        again = _CANVAS_AGAIN.search(name)
        own, time = (_CANVAS_AGAIN.sub("", name), int(again["time"])) if again else (name, 0)
        files = next((other for other in joined if other.files and other.exercise == handed.exercise), None)
        if files is None:
            joined.append(replace(handed, files={own: path}, names={".": [own]}))
        elif own not in files.files or time > latest[handed.exercise, own]:
            together = {**files.files, own: path}
            joined[joined.index(files)] = replace(files, files=together, names={".": sorted(together)})
        else:
            continue
        latest[handed.exercise, own] = time
    return joined
