"""Refuse to import modules that changed since learners' programs began to run: they may write wherever we can."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from types import ModuleType


def refuse_changed_modules() -> None:
    """Raise ImportError for any module that is imported from now on and whose file has changed since now."""
    others = [finder for finder in sys.meta_path if not isinstance(finder, _UnchangedFinder)]
    sys.meta_path[:] = [_UnchangedFinder(), *others]


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
        if type(spec.loader) is SourceFileLoader and spec.cached and self._has_changed(spec.cached):
            spec.loader = _SourceOnlyLoader(fullname, spec.origin)  # compiled by another check, or forged
        return spec

    def _has_changed(self, file: str) -> bool:
        try:  # programs cannot set st_ctime, but it may be in the future if the clock was wrong
            return self._since <= os.stat(file).st_ctime <= time.time()
        except OSError:
            return False


class _SourceOnlyLoader(SourceFileLoader):
    """Ignores cached bytecode and compiles the source."""

    def path_stats(self, path: str) -> dict[str, float]:
        raise OSError
