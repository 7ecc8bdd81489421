"""Load the check of a lesson, and the mistakes that only its exercise can know."""

from __future__ import annotations

import importlib
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from tutor.content import Course, Lesson
from tutor.content.loader import BUNDLED
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
        if isinstance(check, Check) and check.mistakes and not is_ours(source):
            check = replace(check, mistakes=_import_mistakes(check.mistakes, checks_folder(source)))
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
    """Import `checks.NAME` from the course that it belongs to."""
    enter_checks(checks_folder(source))
    importlib.invalidate_caches()
    name = (source.parent if source.name == "__init__.py" else source).stem
    return importlib.import_module(f"checks.{name}")


_imported: dict[Path, dict[str, ModuleType]] = {}
"""The modules of `checks` that were imported from each course's folder: several courses may have the same names."""


def enter_checks(folder: Path) -> None:
    """Let `checks` be the package of this course; of our own, only what has another name is left in it."""
    import checks

    for name in [each for each in sys.modules if each.startswith("checks.")]:
        module = sys.modules.pop(name)
        home = next((each for each in Path(module.__file__ or "").parents if each.name == "checks"), folder)
        _imported.setdefault(home, {})[name] = module
        vars(checks).pop(name.removeprefix("checks."), None)
    ours = (BUNDLED / "checks").resolve()
    own_names = {each.stem for each in folder.iterdir()} if folder.is_dir() and folder != ours else set()
    kept = {name: each for name, each in _imported.get(ours, {}).items() if name.split(".")[1] not in own_names}
    for name, module in {**kept, **_imported.get(folder, {})}.items():
        sys.modules[name] = module
        if name.count(".") == 1:
            setattr(checks, name.removeprefix("checks."), module)
    checks.__path__[:] = dict.fromkeys([str(folder), str(ours)])


def _import_mistakes(name: str, folder: Path) -> str:
    """Import the module with the mistakes of another course, and return a name that it has in no other course."""
    alias = f"{folder}/{name}"
    sys.modules.setdefault(alias, importlib.import_module(name))
    return alias


def checks_folder(source: Path) -> Path:
    """Return the `checks` folder of the course that a check belongs to."""
    return (source.parent.parent if source.name == "__init__.py" else source.parent).resolve()
