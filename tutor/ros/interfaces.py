"""Message, service and action types: the class of one by its name, and the names of all that this ROS has."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

from tutor.errors import UnknownType
from tutor.ros.prefixes import INTERFACE_INDEX, ament_prefixes, indexed

_KINDS = (".msg", ".srv", ".action", ".idl")
_ATTRIBUTES = {"msg": ("SLOT_TYPES",), "srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}

FEEDBACK = "_FeedbackMessage"
"""How the type of an action's feedback topic ends."""


class WrongKind(UnknownType):
    """The type exists but is not the message, service or action that was asked for."""


@cache
def interface_class(name: str) -> Any:
    """Return the class of a type, given a name such as `std_msgs/msg/Float64`.

    Raises UnknownType if the package or the type is not installed.
    """
    try:
        package, kind, type_name = name.split("/")
        if not _has_interfaces(package):  # the name may come from a learner: do not import arbitrary modules
            raise UnknownType(name)
        found: Any = importlib.import_module(f"{package}.{kind}")
        if kind == "action" and type_name.endswith(FEEDBACK):  # its class is only in that of the action
            found = getattr(found, type_name.removesuffix(FEEDBACK)).Impl.FeedbackMessage
        else:
            found = getattr(found, type_name)
    except (ValueError, ImportError, AttributeError) as error:
        raise UnknownType(name) from error
    return found


def find_interface(name: str, kind: str) -> Any:
    """Return the class of a type such as `std_msgs/msg/String` or `std_msgs/String`; `kind` is msg, srv or action.

    Raises UnknownType, or WrongKind if the name belongs to something else.
    """
    package, _, last = name.partition("/")
    found = interface_class(name if "/" in last else f"{package}/{kind}/{last}")
    if not all(hasattr(found, attribute) for attribute in _ATTRIBUTES[kind]):
        raise WrongKind(name)
    return found


def types_by_package(prefixes: Iterable[Path] | None = None) -> dict[str, list[str]]:
    """Map each package that has types to their names, such as `msg/String`, in the order of its ament index file.

    Of two prefixes with the same package, the first wins; the default are those on AMENT_PREFIX_PATH.
    """
    found: dict[str, list[str]] = {}
    for package, prefix in indexed(INTERFACE_INDEX, ament_prefixes() if prefixes is None else prefixes).items():
        lines = (prefix / INTERFACE_INDEX / package).read_text(encoding="utf-8").splitlines()
        names = dict.fromkeys(line.rpartition(".")[0] for line in lines if line.endswith(_KINDS))
        found[package] = [name for name in names if "_" not in name.partition("/")[2]]
    return found


def type_names(kind: str = "") -> list[str]:
    """Return the full names of all types, or of those of one kind (msg, srv or action)."""
    every = types_by_package().items()
    return [f"{package}/{name}" for package, names in every for name in names if name.startswith(kind)]


def _has_interfaces(package: str) -> bool:
    """Return whether a top-level package has type support for messages and services."""
    found = importlib.util.find_spec(package) if package.isidentifier() else None
    places = (found.submodule_search_locations or ()) if found else ()
    return any(any(Path(place).glob(f"{package}_s__rosidl_typesupport_c*.so")) for place in places)
