"""Message, service and action types by name, as rosidl_runtime_py finds them."""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_INDEX = Path("share") / "ament_index" / "resource_index" / "rosidl_interfaces"
_PARTS = {
    "msg": ("SLOT_TYPES",),
    "srv": ("Request", "Response"),
    "action": ("Goal", "Result", "Feedback"),
}


class UnknownInterface(LookupError):
    """There is no such type here, or it is of another kind."""


class OfAnotherKind(UnknownInterface):
    """It is here, but no message, service or action, as it was to be."""


def find_interface(name: str, kind: str) -> Any:
    """The class of a type, from `std_msgs/msg/String` or `std_msgs/String`; `kind` is msg, srv or action.

    Raises UnknownInterface, and OfAnotherKind where there is something else of this name.
    """
    *where, last = name.split("/")
    if len(where) == 1:
        where.append(kind)
    try:
        found = getattr(importlib.import_module(".".join(where)), last)
    except (ImportError, AttributeError, ValueError) as error:
        raise UnknownInterface(name) from error
    if not all(hasattr(found, part) for part in _PARTS[kind]):
        raise OfAnotherKind(name)
    return found


def types_by_package() -> dict[str, list[str]]:
    """The types of each package that has any, such as `msg/String`, in the order of its index in the ament prefixes."""
    found: dict[str, list[str]] = {}
    for index in _indices():
        for package in sorted(index.iterdir()):
            if package.name not in found:  # the first prefix counts
                lines = package.read_text(encoding="utf-8").splitlines()
                kinds = (".msg", ".srv", ".action", ".idl")
                names = dict.fromkeys(line.rpartition(".")[0] for line in lines if line.endswith(kinds))
                found[package.name] = [name for name in names if "_" not in name.partition("/")[2]]
    return dict(sorted(found.items()))


def message_names(**_: object) -> list[str]:
    """All message types, for Tab."""
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
