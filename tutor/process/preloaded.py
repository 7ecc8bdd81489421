"""Modules that a fork server has imported, and that a program forked from it finds only once it imports them itself.

Used by `tutor.process.fork_server`, which is run by file path, so this uses only the standard library.
"""

from __future__ import annotations

import builtins
import importlib
import importlib.util
import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any


class Preloaded:
    """Modules by name, and what each of them imported: a finder on `sys.meta_path` that gives them out on import.

    A module that nobody has imported yet is neither in `sys.modules` nor an attribute of its package. So a program that
    forgets `import std_msgs.msg` fails here as it does anywhere else.
    """

    def __init__(self, modules: Mapping[str, ModuleType], imports: Mapping[str, Iterable[str]]) -> None:
        """`imports`: by the name of a module, the names of those that it imported, even if they were known already."""
        self.modules = dict(modules)
        self._imports = imports
        self.top_level = frozenset(name.partition(".")[0] for name in self.modules)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return how to import a module, unless it is unknown here or the program has one of its own by this name."""
        module = self.modules.get(fullname)
        if module is None or module.__spec__ is None:
            return None
        known = module.__spec__
        if path is None:
            found = PathFinder.find_spec(fullname)
            if found is None or found.origin != known.origin:
                return None
        is_package = known.submodule_search_locations is not None
        spec = ModuleSpec(fullname, self, origin=known.origin, is_package=is_package)  # type: ignore[arg-type]
        spec.loader_state = known
        return spec

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return the module that was imported before the fork."""
        return self.modules[spec.name]

    def exec_module(self, module: ModuleType) -> None:
        """Give out everything that the module imported."""
        spec = module.__spec__
        assert spec is not None
        module.__spec__ = spec.loader_state
        for name in self._closure(spec.name):
            if name not in sys.modules:
                sys.modules[name] = self.modules[name]
            _set_in_package(self.modules[name], name)

    def _closure(self, name: str) -> Iterator[str]:
        """Yield the names of all modules here that this one imported, and that those imported, parents first."""
        todo, seen = [name], {name}
        while todo:
            current = todo.pop()
            yield current
            imported = {known for dependency in self._imports.get(current, ()) for known in _with_parents(dependency)}
            more = imported & self.modules.keys()
            todo += sorted(more - seen, reverse=True)
            seen |= more


def preload(names: Iterable[str]) -> Preloaded:
    """Import modules, and hide them and all that they import, except for the standard library. Skip missing ones."""
    before = set(sys.modules)
    with _imports_recorded() as imports:
        for name in names:
            try:
                importlib.import_module(name)
            except ImportError:
                continue
    hidden = {
        name: module
        for name, module in sys.modules.items()
        if name not in before and name.partition(".")[0] not in sys.stdlib_module_names
    }
    for name, module in hidden.items():
        del sys.modules[name]
        package, _, child = name.rpartition(".")
        if (parent := hidden.get(package) or sys.modules.get(package)) and vars(parent).get(child) is module:
            delattr(parent, child)
    return Preloaded(hidden, imports)


def is_shadowed(names: Iterable[str], folders: Iterable[str]) -> bool:
    """Whether a folder holds a module with one of these names, which a program would import instead of ours."""
    names = frozenset(names)
    for folder in folders:
        try:
            if any(entry.partition(".")[0] in names for entry in os.listdir(folder)):
                return True
        except OSError:
            return True
    return False


@contextmanager
def _imports_recorded() -> Iterator[dict[str, set[str]]]:
    """Record which module imports which, during the block."""
    imports: dict[str, set[str]] = {}
    original = builtins.__import__

    def record(
        name: str,
        globals: Mapping[str, Any] | None = None,
        locals: Mapping[str, Any] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        module = original(name, globals, locals, fromlist or (), level)
        importer = (globals or {}).get("__name__")
        if isinstance(importer, str):
            package = (globals or {}).get("__package__") or importer.rpartition(".")[0]
            full = importlib.util.resolve_name("." * level + name, package) if level else name
            submodules = (f"{full}.{child}" for child in fromlist or ())
            imports.setdefault(importer, set()).update(
                [full, *(submodule for submodule in submodules if submodule in sys.modules)]
            )
        return module

    builtins.__import__ = record
    try:
        yield imports
    finally:
        builtins.__import__ = original


def _with_parents(name: str) -> Iterator[str]:
    parts = name.split(".")
    return (".".join(parts[: count + 1]) for count in range(len(parts)))


def _set_in_package(module: ModuleType, name: str) -> None:
    package, _, child = name.rpartition(".")
    if parent := sys.modules.get(package):
        parent.__dict__.setdefault(child, module)
