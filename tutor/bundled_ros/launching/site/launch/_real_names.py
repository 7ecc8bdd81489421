"""Make every public name of the real packages importable from every module that has it there.

`names.txt` lists these names. We have fewer modules: `_aliases.py` says which of them defines the names of a module
that has no file here, and an alias module is created along with it. A name that a module does not define is resolved
by its `__getattr__`: to the object itself if another module has it, else to a stand-in that raises when used. Modules
that only the real packages have are created on import.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from functools import cache, partial
from importlib.abc import Loader
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from . import _unsupported
from ._aliases import MODULES

_NAMES_FILE = Path(__file__).with_name("names.txt")
_SITE = str(_NAMES_FILE.parents[1])
PACKAGES = frozenset(
    {"launch", "launch_ros", "launch_xml", "launch_yaml", "launch_testing", "launch_testing_ros", "launch_pytest"}
)
_ALIASES = {
    home: [f"{package}.{name}".lstrip(".") for package, names in packages.items() for name in names.split()]
    for home, packages in MODULES.items()
}
_HOME_OF_ALIAS = {alias: home for home, aliases in _ALIASES.items() for alias in aliases}
_STAND_INS: dict[str, type] = {}


def install() -> None:
    """Install the import hook that finds the real packages' modules and completes their names."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())


def complete(module: ModuleType) -> None:
    """Add the real module's remaining names to one of our modules, and create its aliases."""
    if module.__name__ in _modules():
        _install_getattr(module)
    for alias in _ALIASES.get(module.__name__, ()):
        _make_alias(alias, module)


class _Finder:
    """Finds our own modules (to complete them), their aliases and the modules that only the real packages have."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package = fullname.partition(".")[0]
        if package not in PACKAGES:
            return None
        if fullname in _HOME_OF_ALIAS:
            importlib.import_module(_HOME_OF_ALIAS[fullname])
            return _spec(fullname)
        spec = PathFinder.find_spec(fullname, path)
        if spec is not None and spec.origin is not None:
            if spec.origin.startswith(_SITE):
                spec.loader = _CompletingLoader(fullname, spec.origin)
            return spec
        return _spec(fullname) if fullname in _modules() else None


class _CompletingLoader(SourceFileLoader):
    """Loads one of our own modules and completes it."""

    def exec_module(self, module: ModuleType) -> None:
        super().exec_module(module)
        complete(module)  # only now: with circular imports, a module is asked for names that it will define later


class _VirtualLoader(Loader):
    """Creates a module that has no file here. Aliases already exist."""

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return sys.modules.get(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        if module.__name__ in _HOME_OF_ALIAS:
            return
        module.__doc__ = "Not here; each of its names refuses when it is used."
        module.__dict__["__all__"] = sorted(_modules()[module.__name__][1])
        _install_getattr(module)


def _spec(module: str) -> ModuleSpec:
    return ModuleSpec(module, _VirtualLoader(), is_package=_modules()[module][0])


def _install_getattr(module: ModuleType) -> None:
    module.__getattr__ = partial(_resolve, module.__name__)  # type: ignore[method-assign]
    if _modules()[module.__name__][0] and not hasattr(module, "__path__"):
        module.__path__ = []  # a plain file here but a package there: its submodules are aliases


def _make_alias(name: str, home: ModuleType) -> None:
    """Register an alias module. What it defines gets it as `__module__`, for tracebacks and pickle."""
    names = _modules()[name][1]
    alias = ModuleType(name, home.__doc__)
    alias.__spec__ = _spec(name)
    alias.__loader__ = alias.__spec__.loader
    alias.__package__ = alias.__spec__.parent
    alias.__file__ = home.__file__
    alias.__dict__["__all__"] = sorted(each for each, origin in names.items() if not origin or each in vars(home))
    _install_getattr(alias)
    for each, origin in names.items():
        defined = vars(home).get(each)
        if not origin and isinstance(defined, type | FunctionType) and defined.__module__ == home.__name__:
            defined.__module__ = name
    sys.modules[name] = alias


def _resolve(module: str, name: str) -> Any:
    origin = _modules().get(module, (False, {}))[1].get(name)
    if module in _HOME_OF_ALIAS and not name.startswith("__"):
        home = vars(sys.modules[_HOME_OF_ALIAS[module]])
        if name in home:
            return home[name]
    if f"{module}.{name}" in _HOME_OF_ALIAS:
        return importlib.import_module(f"{module}.{name}")
    if origin is None or name.startswith("_"):
        raise AttributeError(f"module {module!r} has no attribute {name!r}")
    if not origin:
        return _stand_in(f"{module}.{name}")
    source, _, attribute = origin.partition(":")
    if not attribute or f"{source}.{attribute}" in _modules():
        return _import_or_stand_in(f"{source}.{attribute}".rstrip("."))
    if source == module:
        return _stand_in(f"{module}.{name}")
    found = _import_or_stand_in(source)
    if isinstance(found, ModuleType):
        found = getattr(found, attribute, None)
    return found if found is not None else _stand_in(f"{source}.{attribute}")


def _import_or_stand_in(module: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError:  # something outside launch that is not installed
        return _stand_in(module)


def _stand_in(what: str) -> type:
    if what not in _STAND_INS:
        _STAND_INS[what] = _unsupported.stand_in(what)
    return _STAND_INS[what]


@cache
def _modules() -> dict[str, tuple[bool, dict[str, str]]]:
    """Map each module to whether it is a package, and to its names with their origins."""
    modules: dict[str, tuple[bool, dict[str, str]]] = {}
    names: dict[str, str] = {}
    for line in _NAMES_FILE.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        name, _, rest = line.strip().partition(" ")
        if line.startswith(" "):
            names[name] = rest
        else:
            names = {}
            modules[name] = (rest == "package", names)
    return modules
