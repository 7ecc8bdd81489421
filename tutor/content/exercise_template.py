"""Makes a new exercise: a copy of the template, an exercise that proves itself, under another id and title."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from pathlib import Path

from tutor.content.courses import MANIFEST, read_manifest
from tutor.errors import StorageError, UsageError

TEMPLATE = Path(__file__).parent / "template"
"""A whole course with one exercise, whose words are replaced by those of the new one."""

_ID = re.compile(r"[a-z]+[0-9]+[._][0-9]+")


def new_exercise(exercise: str, title: str, course: Path) -> list[Path]:
    """Write lesson, skeleton, solution, check and submissions of a new exercise; return the files, lesson first.

    Raises UsageError, with nothing written, for a bad id or title or if the exercise is there already; StorageError.
    """
    if not _ID.fullmatch(exercise.lower()):
        raise UsageError(f"{exercise!r} cannot be the id of an exercise: use letters and two numbers, such as x1.1")
    if not title.strip() or not title.isprintable() or any(character in title for character in '"\\:#'):
        raise UsageError(f'{title!r} cannot be a title: use words, such as "Street Lamp"')
    files = {course / _renamed(source, exercise, title): source for source in _template_files()}
    if (course / MANIFEST).exists():
        read_manifest(course)
        del files[course / MANIFEST]
    for target in files:
        if target.exists():
            raise UsageError(f"there already is {target}; choose another id")
    try:
        for target, source in files.items():
            target.parent.mkdir(parents=True, exist_ok=True)
            text = source.read_text(encoding="utf-8")
            if source.name == MANIFEST:
                text = _own_manifest(text, course)
            target.write_text(_replaced(text, exercise, title), encoding="utf-8")
    except OSError as error:
        raise StorageError.of(f"write to {course}", error) from error
    return sorted(files, key=lambda path: path.name != "lesson.md")


def _template_files() -> Iterator[Path]:
    for path in sorted(TEMPLATE.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            yield path


def _renamed(source: Path, exercise: str, title: str) -> str:
    return _replaced(str(source.relative_to(TEMPLATE)), exercise, title)


def _replaced(text: str, exercise: str, title: str) -> str:
    """Return a text of the template, or a path in it, with the words of the new exercise."""
    number = exercise.lower().replace("_", ".")
    words = _words(title, number)
    for old, new in (
        ("x1.1", number),
        ("X1.1", number.upper()),
        ("x1_1", number.replace(".", "_")),
        ("X1:", f"{number.partition('.')[0].upper()}:"),
        ("street_lamp", "_".join(words)),
        ("StreetLamp", "".join(word.capitalize() for word in words)),
        ("Street Lamp", title.strip()),
    ):
        text = text.replace(old, new)
    return text


def _words(title: str, number: str) -> list[str]:
    """Return the title as words that can make a Python name and a ROS name."""
    ascii_only = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode().lower()
    words = re.findall(r"[a-z0-9]+", ascii_only)
    return words if words and words[0][0].isalpha() else ["node", number.replace(".", "_"), *words]


def _own_manifest(text: str, course: Path) -> str:
    """Return the template's `course.yaml` with the name of the folder."""
    own = read_manifest(course)
    return text.replace("my_course", own.name).replace("My course", own.title)
