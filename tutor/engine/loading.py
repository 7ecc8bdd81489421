"""Load the check of a lesson, its mistakes, and no module that has changed since learners' programs began to run.

Such a program may write wherever we can.
"""

from __future__ import annotations

import ast
import base64
import csv
import hashlib
import importlib
import os
import re
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from difflib import get_close_matches
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from tutor.content import Course, Lesson
from tutor.content.loader import BUNDLED
from tutor.engine.check_errors import as_check_error, guarded, is_ours
from tutor.errors import CheckError, EngineError, MissingType, TableError
from tutor.judge.check import Check
from tutor.ros import bundled_interfaces
from tutor.ros.environment import detect
from tutor.ros.interfaces import types_by_package
from tutor.ros.prefixes import ament_prefixes

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

    for name in [full_name for full_name in sys.modules if full_name.startswith("checks.")]:
        module = sys.modules.pop(name)
        home = next((parent for parent in Path(module.__file__ or "").parents if parent.name == "checks"), folder)
        _imported.setdefault(home, {})[name] = module
        vars(checks).pop(name.removeprefix("checks."), None)
    ours = (BUNDLED / "checks").resolve()
    own_names = {entry.stem for entry in folder.iterdir()} if folder.is_dir() and folder != ours else set()
    kept = {name: module for name, module in _imported.get(ours, {}).items() if name.split(".")[1] not in own_names}
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


# --- types that a check names ---

_TYPE = re.compile(r"([a-z][a-z0-9_]*)/(msg|srv|action)/([A-Z][A-Za-z0-9]*)")


def unknown_types(check: Path) -> Iterator[MissingType]:
    """Yield each unknown type in a check (a module, or the `__init__.py` of a package), with its line."""
    sources = sorted(check.parent.glob("*.py")) if check.name == "__init__.py" else [check]
    named = [(source, line, name) for source in sources for line, name in _named_types(source)]
    if not named:
        return
    types = types_by_package(_prefixes())
    for source, line, name in named:
        package, kind, short = name.split("/")
        known = types.get(package, [])
        if f"{kind}/{short}" not in known:
            yield MissingType(source, name, line, _advice(package, f"{kind}/{short}", known))


def _advice(package: str, wanted: str, known: list[str]) -> str:
    if not known:
        return f"correct the name of the package, or install it (apt install ros-jazzy-{package.replace('_', '-')})"
    near = get_close_matches(wanted, sorted(known), n=1, cutoff=0.5)
    return f"did you mean {package}/{near[0]}?" if near else f"`ros2 interface package {package}` lists those it has"


def _named_types(source: Path) -> Iterator[tuple[int, str]]:
    for node in ast.walk(ast.parse(source.read_bytes())):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and _TYPE.fullmatch(node.value):
            yield node.lineno, node.value


def _prefixes() -> list[Path]:
    """Return the ament prefixes of the ROS in use."""
    prefixes = ament_prefixes()
    return prefixes if detect().kind == "system" else [*prefixes, bundled_interfaces.prefix(), Path(sys.prefix)]


# --- modules that were changed ---


def refuse_changed_modules() -> None:
    """Raise ImportError for any module that is imported from now on and whose file has changed since now."""
    others = [finder for finder in sys.meta_path if not isinstance(finder, _UnchangedFinder)]
    sys.meta_path[:] = [_UnchangedFinder(), *others]


@contextmanager
def changes_trusted() -> Iterator[None]:
    """Within the block, import what has changed as well: what we have just built ourselves."""
    finders = [finder for finder in sys.meta_path if isinstance(finder, _UnchangedFinder)]
    sys.meta_path[:] = [finder for finder in sys.meta_path if finder not in finders]
    try:
        yield
    finally:
        sys.meta_path[:] = [*finders, *(finder for finder in sys.meta_path if finder not in finders)]


class _UnchangedFinder(MetaPathFinder):
    """Delegates to the finders after it, and refuses what they find if its file has changed."""

    def __init__(self) -> None:
        self._since = time.time()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        finders_after = sys.meta_path[sys.meta_path.index(self) + 1 :]
        specs = (finder.find_spec(fullname, path, target) for finder in finders_after)
        spec = next((spec for spec in specs if spec is not None), None)
        if spec is None or not spec.has_location or spec.origin is None:
            return spec
        if self._has_changed(spec.origin):
            raise ImportError(f"{spec.origin} was changed while a program was checked", name=fullname)
        if type(spec.loader) is SourceFileLoader and spec.cached and self._was_touched(spec.cached):
            spec.loader = _SourceOnlyLoader(fullname, spec.origin)  # compiled by another check, or forged
        return spec

    def _has_changed(self, file: str) -> bool:
        return self._was_touched(file) and not self._is_as_installed(Path(file))

    def _was_touched(self, file: str | Path) -> bool:
        try:  # programs cannot set st_ctime, but it may be in the future if the clock was wrong
            return self._since <= os.stat(file).st_ctime <= time.time()
        except OSError:
            return False

    def _is_as_installed(self, file: Path) -> bool:
        """Whether a file still has the contents that its package's RECORD states, which was not touched itself.

        uv installs by hard links: each environment that gets the same package, or is removed, changes st_ctime.
        """
        for folder in file.parents:
            if records := list(folder.glob("*.dist-info/RECORD")):
                wanted = file.relative_to(folder).as_posix()
                stated = [_stated_digest(record, wanted) for record in records if not self._was_touched(record)]
                return _digest(file) in stated
        return False


def _stated_digest(record: Path, wanted: str) -> str:
    """Return the digest of a file in a RECORD ("sha256=..."), or "" if it states none."""
    with record.open(encoding="utf-8", newline="") as lines:
        return next((row[1] for row in csv.reader(lines) if row[:1] == [wanted]), "")


def _digest(file: Path) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_bytes()).digest())
    return f"sha256={digest.decode().rstrip('=')}"


class _SourceOnlyLoader(SourceFileLoader):
    """Ignores cached bytecode and compiles the source."""

    def path_stats(self, path: str) -> dict[str, float]:
        raise OSError
