"""Load the check of a lesson, and the mistakes that only its exercise can know."""

from __future__ import annotations

import importlib
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from tutor.content import Course, Lesson
from tutor.engine.check_errors import as_check_error, guarded, is_ours
from tutor.engine.interface_types import unknown_types
from tutor.errors import CheckError, EngineError, TableError
from tutor.judge.check import Check

if TYPE_CHECKING:
    from tutor.mistakes import Catalogue


def load_check(lesson: Lesson) -> Check:
    """Load the check of a lesson: `CHECK` in the package or module `lesson.check`.

    Raises CheckError if it is missing, cannot be loaded, or names a type that this ROS does not have.
    """
    source = lesson.check
    if not source.is_file():
        raise CheckError(source, f"there is no such file, so nothing judges {lesson.id}")
    try:
        check = getattr(_import_check(source), "CHECK", None)
    except TableError as error:
        raise CheckError(source, f"it has a table that cannot be used: {error}") from error
    except Exception as error:
        found = as_check_error(error, checks_folder(source))
        raise found or CheckError(source, f"it cannot be loaded: {type(error).__name__}: {error}") from error
    if not isinstance(check, Check):
        raise CheckError(source, "it defines no CHECK: assign a Check to CHECK")
    if check.exercise == lesson.own_id != lesson.id:
        check = replace(check, exercise=lesson.id)
    if is_ours(source):
        return check
    for unknown in unknown_types(source):
        raise unknown
    return guarded(check, checks_folder(source))


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

    name = (source.parent if source.name == "__init__.py" else source).stem
    folder = str(checks_folder(source))
    checks.__path__[:] = [folder, *(path for path in checks.__path__ if path != folder)]
    loaded = sys.modules.get(f"checks.{name}")
    if loaded is not None and Path(loaded.__file__ or "") != source.resolve():  # from a course loaded before
        for module in [each for each in sys.modules if f"{each}.".startswith(f"checks.{name}.")]:
            del sys.modules[module]
    importlib.invalidate_caches()
    return importlib.import_module(f"checks.{name}")


def checks_folder(source: Path) -> Path:
    """Return the `checks` folder of the course that a check belongs to."""
    return (source.parent.parent if source.name == "__init__.py" else source.parent).resolve()
