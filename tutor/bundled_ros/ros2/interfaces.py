"""Look up message, service and action types by name, as rosidl_runtime_py does."""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_INDEX = Path("share") / "ament_index" / "resource_index" / "rosidl_interfaces"
_REQUIRED_ATTRIBUTES = {
    "msg": ("SLOT_TYPES",),
    "srv": ("Request", "Response"),
    "action": ("Goal", "Result", "Feedback"),
}


class UnknownInterface(LookupError):
    """No such type exists here, or it is of another kind."""


class WrongInterfaceKind(UnknownInterface):
    """The type exists but is not the message, service or action that was asked for."""


def find_interface(name: str, kind: str) -> Any:
    """Return the class of a type such as `std_msgs/msg/String` or `std_msgs/String`; `kind` is msg, srv or action.

    Raises UnknownInterface, or WrongInterfaceKind if the name belongs to something else.
    """
    *path, last = name.split("/")
    if len(path) == 1:
        path.append(kind)
    try:
        found = getattr(importlib.import_module(".".join(path)), last)
    except (ImportError, AttributeError, ValueError) as error:
        raise UnknownInterface(name) from error
    if not all(hasattr(found, attribute) for attribute in _REQUIRED_ATTRIBUTES[kind]):
        raise WrongInterfaceKind(name)
    return found


def types_by_package() -> dict[str, list[str]]:
    """Map each package that has types to their names, such as `msg/String`, in the order of its ament index file."""
    found: dict[str, list[str]] = {}
    for index in _indices():
        for package in sorted(index.iterdir()):
            if package.name not in found:  # the first prefix wins
                lines = package.read_text(encoding="utf-8").splitlines()
                kinds = (".msg", ".srv", ".action", ".idl")
                names = dict.fromkeys(line.rpartition(".")[0] for line in lines if line.endswith(kinds))
                found[package.name] = [name for name in names if "_" not in name.partition("/")[2]]
    return dict(sorted(found.items()))


def message_names(**_: object) -> list[str]:
    """Return all message types, for Tab completion."""
    return [
        f"{package}/{name}"
        for package, names in types_by_package().items()
        for name in names
        if name.startswith("msg/")
    ]


def _indices() -> Iterator[Path]:
    for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        if entry and (index := Path(entry) / _INDEX).is_dir():
            yield index
