"""The check that belongs to a lesson."""

from __future__ import annotations

import importlib
import importlib.util
from pathlib import Path
from types import ModuleType

from tutor.content import Lesson
from tutor.engine.errors import EngineError
from tutor.judge.check import Check
from tutor.judge.exceptions import TableError


def load_check(lesson: Lesson) -> Check:
    """The check of a lesson: `CHECK` in the package or module `lesson.check`.

    Raises EngineError where there is none.
    """
    source = lesson.check
    if not source.is_file():
        raise EngineError(f"there is no check for {lesson.id}: {source} is missing", f"write {source}")
    try:
        check = getattr(_module(lesson.folder.name, source), "CHECK", None)
    except TableError as error:
        raise EngineError(f"the check of {lesson.id} has a table that cannot be used: {error}", "fix it") from error
    if not isinstance(check, Check):
        raise EngineError(f"{source} defines no CHECK", "assign a tutor.judge.check.Check to CHECK there")
    return check


def _module(name: str, source: Path) -> ModuleType:
    own = importlib.util.find_spec("checks")
    if own is not None and any(source.is_relative_to(place) for place in own.submodule_search_locations or ()):
        return importlib.import_module(f"checks.{name}")
    spec = importlib.util.spec_from_file_location(f"checks_of_course.{name}", source)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
