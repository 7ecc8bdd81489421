"""Finds the message, service and action types that the code of a check names and this ROS does not have."""

from __future__ import annotations

import ast
import os
import re
import sys
from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path

from tutor.errors import MissingType
from tutor.ros import bundled_interfaces
from tutor.ros.environment import detect

_TYPE = re.compile(r"([a-z][a-z0-9_]*)/(msg|srv|action)/([A-Z][A-Za-z0-9]*)")
_INDEX = Path("share") / "ament_index" / "resource_index" / "rosidl_interfaces"


def unknown_types(check: Path) -> Iterator[MissingType]:
    """Yield each unknown type in a check (a module, or the `__init__.py` of a package), with its line."""
    sources = sorted(check.parent.glob("*.py")) if check.name == "__init__.py" else [check]
    named = [(source, line, name) for source in sources for line, name in _named_types(source)]
    if not named:
        return
    prefixes = _prefixes()
    for source, line, name in named:
        package, kind, short = name.split("/")
        known = _types_of(package, prefixes)
        if f"{kind}/{short}" not in known:
            yield MissingType(source, name, line, _advice(package, f"{kind}/{short}", known))


def _advice(package: str, wanted: str, known: set[str]) -> str:
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
    entries = [Path(entry) for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]
    return entries if detect().kind == "system" else [*entries, bundled_interfaces.prefix(), Path(sys.prefix)]


def _types_of(package: str, prefixes: list[Path]) -> set[str]:
    """Return the types of a package, such as `msg/String`; empty if it is not there."""
    for prefix in prefixes:
        try:
            lines = (prefix / _INDEX / package).read_text(encoding="utf-8").splitlines()
        except OSError:
            continue
        return {line.rpartition(".")[0] for line in lines if line.endswith((".msg", ".srv", ".action", ".idl"))}
    return set()
