"""What we import while learners' programs run, or after that, is as it was before: they may write where we can."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from types import ModuleType


def refuse_changed_modules() -> None:
    """From now on, refuse to import a module whose file changes from now on (ImportError)."""
    others = [finder for finder in sys.meta_path if not isinstance(finder, _Unchanged)]
    sys.meta_path[:] = [_Unchanged(), *others]


class _Unchanged(MetaPathFinder):
    """Has the finders behind it find modules, and looks at what they have found."""

    def __init__(self) -> None:
        self._since = time.time()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        behind = sys.meta_path[sys.meta_path.index(self) + 1 :]
        specs = (finder.find_spec(fullname, path, target) for finder in behind)
        spec = next((spec for spec in specs if spec is not None), None)
        if spec is None or not spec.has_location or spec.origin is None:
            return spec
        if self._has_changed(spec.origin):
            raise ImportError(f"{spec.origin} was changed while a program was checked", name=fullname)
        if type(spec.loader) is SourceFileLoader and spec.cached and self._has_changed(spec.cached):
            spec.loader = _NotCompiled(fullname, spec.origin)  # another check may just have compiled it; or the program
        return spec

    def _has_changed(self, file: str) -> bool:
        try:  # the time of a change is the system's: nobody can set it, but a clock that was wrong may be ahead
            return self._since <= os.stat(file).st_ctime <= time.time()
        except OSError:
            return False


class _NotCompiled(SourceFileLoader):
    """Compiles the source itself."""

    def path_stats(self, path: str) -> dict[str, float]:
        raise OSError
