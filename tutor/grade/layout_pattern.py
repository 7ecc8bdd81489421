"""A layout that the teacher describes: a path with placeholders, such as `{learner}/{exercise}`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tutor.content import Course
from tutor.errors import UsageError
from tutor.grade.archives import stem

_PLACEHOLDER = re.compile(r"\{(\w*)\}")
_TOOLS = (
    *(".git", ".github", ".gitlab", ".venv", ".vscode", ".idea", ".ros-tutor", ".ruff_cache", ".mypy_cache"),
    *(".pytest_cache", ".Trash", "__MACOSX", "__pycache__"),
)
_ORDER = ("{learner}", "{exercise}")
_FIELDS = ("learner", "exercise", "name", "number", "email")


@dataclass(frozen=True, slots=True)
class Match:
    """A path that fits, and what the placeholders stand for. `whole`: it fits to the end of the pattern."""

    path: Path
    fields: Mapping[str, str]
    whole: bool


class LayoutPattern:
    """A layout, which `match` finds in a folder; `*` in it stands for any text."""

    def __init__(self, text: str, course: Course) -> None:
        """Raise UsageError for a pattern that cannot be used."""
        unknown = [name for name in _PLACEHOLDER.findall(text) if name not in _FIELDS]
        if unknown or "{learner}" not in text:
            what = f"{{{unknown[0]}}} is unknown" if unknown else "{learner} is missing"
            raise UsageError(f"--layout {text}: {what}; it may have {', '.join(f'{{{name}}}' for name in _FIELDS)}")
        ids = "|".join(re.sub(r"\\?[._-]", "[._-]", re.escape(lesson.id)) for lesson in course.lessons)
        # Where the name of an exercise can be told from the rest, it is; else anything may be one.
        parts = [part for part in text.split("/") if part]
        self._parts = [[_compile(part, exercise) for exercise in (f"(?i:{ids})", ".+?")] for part in parts]
        depths = {field: next((depth for depth, part in enumerate(parts) if field in part), -1) for field in _ORDER}
        self.learner_comes_first = depths["{learner}"] < depths["{exercise}"]
        """Whether the folders of exercises are in those of learners, who may have misnamed them."""

    def match(self, root: Path) -> Iterator[Match]:
        """Yield all that fits, in the order of names; a learner below whose folder nothing fits is yielded as well."""
        yield from self._match(root, 0, {})

    def _match(self, folder: Path, depth: int, fields: Mapping[str, str]) -> Iterator[Match]:
        for entry in visible(folder):
            found = self._fields(entry, depth)
            if found is None or any(fields.get(name, value) != value for name, value in found.items()):
                continue
            known = {**fields, **found}
            if depth + 1 == len(self._parts):
                yield Match(entry, known, whole=True)
                continue
            below = list(self._match(entry, depth + 1, known)) if _may_enter(entry, folder, depth) else []
            yield from below
            if not below and "learner" in known:
                yield Match(entry, known, whole=False)

    def _fields(self, entry: Path, depth: int) -> dict[str, str] | None:
        names = (entry.name,) if entry.is_dir() else (stem(entry), entry.name)
        matches = (pattern.fullmatch(name) for pattern in self._parts[depth] for name in names)
        match = next(filter(None, matches), None)
        return None if match is None else match.groupdict()


def visible(folder: Path) -> list[Path]:
    """Return what is in a folder, by name, without hidden files and the folders of tools. Raises UsageError."""
    try:
        entries = sorted(folder.iterdir())
        return [entry for entry in entries if entry.name not in _TOOLS and (entry.name[0] != "." or entry.is_dir())]
    except OSError as error:
        raise UsageError(f"cannot read {folder}: {error.strerror}") from error


def _may_enter(entry: Path, folder: Path, depth: int) -> bool:
    """Whether this is a folder, and no link by which a learner shows what is not theirs."""
    if not entry.is_symlink():
        return entry.is_dir()
    return depth == 0 and entry.is_dir() and not entry.resolve().is_relative_to(folder.resolve())


def _compile(part: str, exercise: str) -> re.Pattern[str]:
    text, position = "", 0
    names = set()
    for match in _PLACEHOLDER.finditer(part):
        name = match[1]
        anything = exercise if name == "exercise" else ".+?"
        text += _literal(part[position : match.start()]) + (
            f"(?P={name})" if name in names else f"(?P<{name}>{anything})"
        )
        names.add(name)
        position = match.end()
    return re.compile(text + _literal(part[position:]), re.DOTALL)


def _literal(text: str) -> str:
    return re.escape(text).replace(r"\*", ".*")
