"""The courses that a workspace remembers: those with which an exercise was started in it."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from tutor.content.courses import Courses, find_course, read_manifest
from tutor.errors import ContentError, StorageError, UsageError
from tutor.invocation import command
from tutor.json_codec import convert_to, read_document, write_document
from tutor.workspace.atomic import write_atomically
from tutor.workspace.damaged import set_aside
from tutor.workspace.regular import read_text

SCHEMA = "ros-tutor/courses/1"


@dataclass(frozen=True, slots=True)
class _Saved:
    """The content of the file: each course as the user named it, with absolute paths."""

    courses: tuple[str, ...] = ()
    only: bool = False


class RememberedCourses:
    """The file with the courses of one workspace."""

    def __init__(self, path: Path, notify: Callable[[str], None]) -> None:
        self.path = path
        self._notify = notify

    def read(self) -> Courses:
        """Read the courses; none if there is no file. One that is gone, or damaged, is left out, with a message."""
        saved = self._load()
        found = Courses()
        for given in saved.courses:
            try:
                more = Courses.find([given])
            except (UsageError, StorageError) as error:
                why, forget = str(error).removeprefix("--lessons "), command("list", "--forget", given)
                self._notify(f"a course of this workspace cannot be used: {why}; `{forget}` forgets it")
                continue
            found = Courses((*found.folders, *more.folders), given=(*found.given, *more.given))
        return Courses(found.folders, saved.only and bool(found.folders), found.given)

    def add(self, courses: Courses) -> None:
        """Remember these courses, too. Raises StorageError."""
        before = self._load()
        after = _Saved(tuple(dict.fromkeys((*before.courses, *courses.given))), courses.only)
        if courses.given and after != before:
            write_atomically(self.path, write_document(SCHEMA, courses=after.courses, only=after.only))

    def forget(self, course: str) -> None:
        """Forget a course, given by its name, its folder or its file; one that is gone, too.

        Raises UsageError if the workspace does not remember it, and StorageError.
        """
        before = self._load()
        kept = tuple(given for given in before.courses if not _is_called(given, course))
        if kept == before.courses:
            known = f"it remembers {', '.join(kept)}" if kept else "it remembers none"
            raise UsageError(f"--forget {course}: this workspace does not remember such a course; {known}")
        write_atomically(self.path, write_document(SCHEMA, courses=kept, only=before.only and bool(kept)))

    def _load(self) -> _Saved:
        try:
            return convert_to(_Saved, read_document(read_text(self.path), SCHEMA))
        except (FileNotFoundError, NotADirectoryError):  # a file in place of the workspace is told where it is opened
            return _Saved()
        except OSError as error:
            raise StorageError.of(f"read {self.path}", error) from error
        except ValueError as reason:
            aside = set_aside(self.path)
            self._notify(f"the courses of this workspace could not be read ({reason}); the file is kept as {aside}")
            return _Saved()


def _is_called(given: str, name: str) -> bool:
    """Whether a remembered course has this name, or is this folder or file."""
    if name in (given, Path(given).name) or os.path.abspath(Path(name).expanduser()) == given:
        return True
    with suppress(UsageError, StorageError, ContentError):  # one that is gone has no name any more
        return read_manifest(find_course(given)).name == name
    return False
