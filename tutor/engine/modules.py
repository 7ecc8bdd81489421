"""The check module that belongs to a lesson."""

from __future__ import annotations

import importlib
import importlib.util
from types import ModuleType

from tutor.content import Lesson
from tutor.engine.errors import EngineError
from tutor.judge.check import Check


def load_check(lesson: Lesson) -> Check:
    """The check of a lesson: `CHECK` in the module of its folder's name, from `checks/` beside `lessons/`.

    Raises EngineError where there is none.
    """
    name = lesson.folder.name
    source = lesson.folder.parent.parent / "checks" / f"{name}.py"
    if not source.is_file():
        raise EngineError(f"there is no check for {lesson.id}: {source} is missing", f"write {source}")
    check = getattr(_module(name, source), "CHECK", None)
    if not isinstance(check, Check):
        raise EngineError(f"{source} defines no CHECK", "assign a tutor.judge.check.Check to CHECK there")
    return check


def _module(name: str, source: object) -> ModuleType:
    own = importlib.util.find_spec("checks")
    if own is not None and own.submodule_search_locations and str(source).startswith(f"{own.submodule_search_locations[0]}/"):
        return importlib.import_module(f"checks.{name}")
    spec = importlib.util.spec_from_file_location(f"checks_of_course.{name}", str(source))
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
