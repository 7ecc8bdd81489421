"""Courses: where they are, what they are called, and which of them are in use.

A course is a folder with `lessons/`, `checks/` and, as a rule, `course.yaml`:

    format: 1                       # the format of the folder: this ros-tutor knows 1
    name: lamps                     # short; where two courses have an exercise x1.1, this one's is lamps:x1.1
    title: Lamps and switches       # its heading

It is given as the folder, as a file that `ros-tutor author pack` has made of it, or by the name under which an
installed package offers it: an entry point of the group `ros_tutor.courses` that names the package with these folders.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from tutor.content import packing
from tutor.content.fields import Document
from tutor.errors import ContentError, UsageError

MANIFEST = "course.yaml"
FORMAT = 1
ENTRY_POINTS = "ros_tutor.courses"

_NAME = re.compile(r"[a-z][a-z0-9_-]*")


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a course says of itself. Without a `course.yaml`, `name` and `title` are those of its folder."""

    name: str
    title: str
    stated: bool


@dataclass(frozen=True, slots=True)
class Courses:
    """The courses in use beside the bundled one, or with `only`, instead of it.

    `given` names each of `folders` as the user did, with absolute paths.
    """

    folders: tuple[Path, ...] = ()
    only: bool = False
    given: tuple[str, ...] = ()

    @classmethod
    def find(cls, given: Iterable[str | Path], *, only: bool = False) -> Courses:
        """Find the courses named. Raises UsageError for one that is not there."""
        texts = [str(name) for name in given]
        folders = tuple(find_course(text) for text in texts)
        return cls(folders, only, tuple(_absolute(text) for text in texts))

    @property
    def arguments(self) -> list[str]:
        """The options with which another of our processes uses the same courses."""
        options = [word for folder in self.folders for word in ("--lessons", str(folder))]
        return [*options, "--only"] if self.only else options


def find_course(text: str) -> Path:
    """Return the folder of a course given as a folder, a packed file or a name. Raises UsageError and ContentError."""
    path = Path(os.path.abspath(Path(text).expanduser()))
    if path.is_dir():
        if not (path / "lessons").is_dir():
            raise UsageError(f"--lessons {text}: it has no lessons/ folder")
        return path
    if path.is_file():
        return packing.unpacked(path)
    if _NAME.fullmatch(text):
        installed = _installed_courses()
        if text in installed:
            return installed[text]
        known = f"; installed are {', '.join(sorted(installed))}" if installed else ""
        raise UsageError(f"--lessons {text}: there is no such folder or file, and no installed course{known}")
    raise UsageError(f"--lessons {text}: there is no such folder or file")


def _absolute(text: str) -> str:
    path = Path(text).expanduser()
    return os.path.abspath(path) if path.exists() else text


def _installed_courses() -> dict[str, Path]:
    """Return the folders of the courses that installed packages offer, by name. Imports none of these packages."""
    from importlib import metadata, util

    found: dict[str, Path] = {}
    for entry in metadata.entry_points(group=ENTRY_POINTS):
        try:
            spec = util.find_spec(entry.module)
        except (ImportError, ValueError):
            continue
        for place in (spec.submodule_search_locations or ()) if spec is not None else ():
            if (Path(place) / "lessons").is_dir():
                found.setdefault(entry.name, Path(place))
    return found


def read_manifest(folder: Path) -> Manifest:
    """Read a course's `course.yaml`. Raises ContentError, also for a format that is not known here."""
    file = folder / MANIFEST
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        name = re.sub(r"[^a-z0-9_-]+", "-", folder.resolve().name.lower()).strip("-") or "course"
        return Manifest(name if _NAME.fullmatch(name) else f"course-{name}", folder.resolve().name, stated=False)
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(file, f"cannot read it: {error}") from error
    fields = Document(file, text).read()
    format = fields.anything("format")
    if format != FORMAT:
        found = "no format" if format is None else f"format {format}"
        raise fields.error("format", f"it has {found}, and this ros-tutor knows format {FORMAT}")
    name = fields.text("name")
    if not _NAME.fullmatch(name):
        raise fields.error("name", f"{name!r} has more than lowercase letters, digits, - and _, or begins with a digit")
    manifest = Manifest(name, fields.text("title", optional=True) or name, stated=True)
    fields.done()
    return manifest
