"""The check that belongs to a lesson."""

from __future__ import annotations

import importlib
import importlib.util
from pathlib import Path
from types import ModuleType

from tutor.content import Lesson
from tutor.engine.errors import EngineError
from tutor.judge.check import Check


def load_check(lesson: Lesson) -> Check:
    """The check of a lesson: `CHECK` in the module or package of its folder's name, in `checks/` beside `lessons/`.

    Raises EngineError where there is none.
    """
    name = lesson.folder.name
    checks = lesson.folder.parent.parent / "checks"
    source = next((file for file in (checks / name / "__init__.py", checks / f"{name}.py") if file.is_file()), None)
    if source is None:
        raise EngineError(f"there is no check for {lesson.id} in {checks}", f"write {checks / name}.py")
    check = getattr(_module(name, source), "CHECK", None)
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
