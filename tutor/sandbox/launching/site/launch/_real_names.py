"""Lets every public name of the real packages be imported from every module that has it there.

`names.txt` lists them. What a module of ours does not define, its `__getattr__` gives: the thing itself where another
of our modules has it, else a stand-in that refuses when it is used. Modules that are not here are made on the spot.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from functools import cache, partial
from importlib.abc import Loader
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import ModuleType
from typing import Any

from . import _unsupported

_LIST = Path(__file__).with_name("names.txt")
_SITE = str(_LIST.parents[1])
PACKAGES = frozenset(
    {"launch", "launch_ros", "launch_xml", "launch_yaml", "launch_testing", "launch_testing_ros", "launch_pytest"}
)
_STAND_INS: dict[str, type] = {}


def install() -> None:
    """From here on, modules of the real packages are found, and have all names that they have there."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())


def complete(module: ModuleType) -> None:
    """Give a module of ours the names that the real one has besides."""
    module.__getattr__ = partial(_get, module.__name__)  # type: ignore[method-assign]


class _Finder:
    """Finds our modules, to complete them, and those that only the real packages have."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package = fullname.partition(".")[0]
        if package not in PACKAGES:
            return None
        spec = PathFinder.find_spec(fullname, path)
        if spec is not None and spec.origin is not None:
            if spec.origin.startswith(_SITE):
                spec.loader = _Completing(fullname, spec.origin)
            return spec
        if fullname not in _modules():
            return None
        return ModuleSpec(fullname, _Making(), is_package=_modules()[fullname][0])


class _Completing(SourceFileLoader):
    """Loads a module of ours."""

    def exec_module(self, module: ModuleType) -> None:
        super().exec_module(module)
        complete(module)  # not before: of modules that import each other, one is asked for what it has not yet


class _Making(Loader):
    """Makes a module that is not here."""

    def create_module(self, spec: ModuleSpec) -> None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        names = _modules()[module.__name__][1]
        module.__doc__ = "Not here; each of its names refuses when it is used."
        module.__dict__["__all__"] = sorted(names)
        complete(module)


def _get(module: str, name: str) -> Any:
    origin = _modules().get(module, (False, {}))[1].get(name)
    if origin is None or name.startswith("_"):
        raise AttributeError(f"module {module!r} has no attribute {name!r}")
    if not origin:
        return _stand_in(f"{module}.{name}")
    source, _, attribute = origin.partition(":")
    if not attribute or f"{source}.{attribute}" in _modules():
        return _or_stand_in(f"{source}.{attribute}".rstrip("."))
    if source == module:
        return _stand_in(f"{module}.{name}")
    found = _or_stand_in(source)
    if isinstance(found, ModuleType):
        found = getattr(found, attribute, None)
    return found if found is not None else _stand_in(f"{source}.{attribute}")


def _or_stand_in(module: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError:  # of something beside launch that is not installed
        return _stand_in(module)


def _stand_in(what: str) -> type:
    if what not in _STAND_INS:
        _STAND_INS[what] = _unsupported.stand_in(what)
    return _STAND_INS[what]


@cache
def _modules() -> dict[str, tuple[bool, dict[str, str]]]:
    """For each module whether it is a package, and its names with their origins."""
    modules: dict[str, tuple[bool, dict[str, str]]] = {}
    names: dict[str, str] = {}
    for line in _LIST.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        name, _, rest = line.strip().partition(" ")
        if line.startswith(" "):
            names[name] = rest
        else:
            names = {}
            modules[name] = (rest == "package", names)
    return modules
