"""Load the check of a lesson, and the mistakes that only its exercise can know."""

from __future__ import annotations

import importlib
import sys
import traceback
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from tutor.content import Course, Lesson
from tutor.errors import EngineError, TableError
from tutor.judge.check import Check

if TYPE_CHECKING:
    from tutor.mistakes import Catalogue


def load_check(lesson: Lesson) -> Check:
    """Load the check of a lesson: `CHECK` in the package or module `lesson.check`.

    Raises EngineError if it is missing or cannot be loaded.
    """
    source = lesson.check
    if not source.is_file():
        raise EngineError(f"there is no check for {lesson.id}: {source} is missing", f"write {source}")
    try:
        check = getattr(_import_check(source), "CHECK", None)
    except TableError as error:
        raise EngineError(f"the check of {lesson.id} has a table that cannot be used: {error}", "fix it") from error
    except Exception as error:
        raise EngineError(
            f"the check of {lesson.id} cannot be loaded: {_location(error, source)}: {type(error).__name__}: {error}",
            "fix the check",
        ) from error
    if not isinstance(check, Check):
        raise EngineError(f"{source} defines no CHECK", "assign a tutor.judge.check.Check to CHECK there")
    return check


def load_catalogues(course: Course) -> list[Catalogue]:
    """The catalogues of mistakes that only the exercises of a course can know, in the course's order.

    A lesson whose check cannot be loaded has none. Raises EngineError if the module that a check names has none.
    """
    found = []
    for lesson in course.lessons:
        try:
            check = load_check(lesson)
        except EngineError:
            continue
        if check.mistakes:
            found.append(_load_catalogue(check))
    return found


def _load_catalogue(check: Check) -> Catalogue:
    from tutor.mistakes import Catalogue  # late: judging needs it only when something has failed

    catalogue = getattr(importlib.import_module(check.mistakes), "CATALOGUE", None)
    if not isinstance(catalogue, Catalogue):
        raise EngineError(f"{check.mistakes} defines no CATALOGUE", "assign a tutor.mistakes.Catalogue to it")
    return catalogue


def _import_check(source: Path) -> ModuleType:
    """Import `checks.NAME`, from our own course or from another, whose folder is put first in the package's path."""
    import checks

    path = source.parent if source.name == "__init__.py" else source
    name, folder = path.stem, str(path.parent.resolve())
    checks.__path__[:] = [folder, *(path for path in checks.__path__ if path != folder)]
    loaded = sys.modules.get(f"checks.{name}")
    if loaded is not None and Path(loaded.__file__ or "") != source.resolve():  # from a course loaded before
        for module in [each for each in sys.modules if f"{each}.".startswith(f"checks.{name}.")]:
            del sys.modules[module]
    importlib.invalidate_caches()
    return importlib.import_module(f"checks.{name}")


def _location(error: Exception, source: Path) -> str:
    """The innermost file and line of the check itself in the exception's traceback."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno}"
    frames = [
        frame for frame in traceback.extract_tb(error.__traceback__) if Path(frame.filename).parent == source.parent
    ]
    return f"{frames[-1].filename}:{frames[-1].lineno}" if frames else str(source)
