"""`ros2 interface`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2 import completion
from tutor.bundled_ros.ros2.names import class_of_type
from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs, argument, flag
from tutor.errors import CommandError
from tutor.ros.interfaces import types_by_package

_TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}
_PARTS = {"msg": "", "srv": "Request", "action": "Goal"}


def _list(arguments: argparse.Namespace) -> None:
    """Print all types, by kind."""
    found = types_by_package()
    for kind in _selected_kinds(arguments):
        print(f"{_TITLES[kind]}:")
        for package, names in found.items():
            for name in sorted(_of_kind(names, kind)):
                print(f"    {package}/{name}")


def _package(arguments: argparse.Namespace) -> None:
    """Print the types of a package. Raises CommandError if there is no such package."""
    package = arguments.package_name
    names = types_by_package().get(package)
    if names is None and not packages.has_package(package):
        raise CommandError(f"Unknown package '{package}'")
    for kind in _selected_kinds(arguments):
        for name in _of_kind(names or [], kind):
            print(f"{package}/{name}")


def _packages(arguments: argparse.Namespace) -> None:
    """Print the packages that have types of the selected kinds."""
    kinds = _selected_kinds(arguments)
    kinds = kinds if len(kinds) == len(_TITLES) else kinds[:1]  # like ros2cli, which uses only the first of two
    for package, names in types_by_package().items():
        if any(_of_kind(names, kind) for kind in kinds):
            print(package)


def _proto(arguments: argparse.Namespace) -> None:
    """Print a message, request or goal with its default values. Raises CommandError."""
    from tutor.ros.yaml_format import to_yaml

    parts = arguments.type.split("/")
    if len(parts) != 3 or parts[1] not in _PARTS:
        raise CommandError(f"Invalid name '{arguments.type}'. Expected three parts separated by '/'")
    found = class_of_type(arguments.type, parts[1], f"Unknown type '{arguments.type}'")
    text = to_yaml((getattr(found, _PARTS[parts[1]]) if _PARTS[parts[1]] else found)())
    print(text if arguments.no_quotes else f'"{text}"')


def _selected_kinds(arguments: argparse.Namespace) -> list[str]:
    """Return the kinds that were selected; all if none was."""
    flags = {"msg": arguments.only_msgs, "srv": arguments.only_srvs, "action": arguments.only_actions}
    return [kind for kind, is_selected in flags.items() if is_selected] or list(flags)


def _of_kind(names: list[str], kind: str) -> list[str]:
    """Return those of names such as `msg/String` that are of this kind."""
    return [name for name in names if name.startswith(f"{kind}/")]


def _complete_packages(**_: object) -> list[str]:
    """Complete packages that have types."""
    return list(types_by_package())


_KINDS = (
    flag("-m", "--only-msgs", help="only message types"),
    flag("-s", "--only-srvs", help="only service types"),
    flag("-a", "--only-actions", help="only action types"),
)
_VERBS: Verbs = {
    "list": ("List all message, service and action types", Verb(_list, *_KINDS)),
    "package": (
        "List the types of a package",
        Verb(
            _package,
            *_KINDS,
            argument("package_name", complete=_complete_packages, help="the package, such as std_msgs"),
        ),
    ),
    "packages": ("List the packages that have types", Verb(_packages, *_KINDS)),
    "proto": (
        "Show an example of a type's value, as YAML",
        Verb(
            _proto,
            argument("type", complete=completion.types_of_kind(), help="the type, such as geometry_msgs/msg/Twist"),
            flag("--no-quotes", help="without the quotation marks around it"),
        ),
    ),
    "show": ("Show how a type is defined", "interface.show"),
}
GRAMMAR = {"interface": Group(_VERBS)}
