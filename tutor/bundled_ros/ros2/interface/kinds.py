"""Choosing between messages, services and actions, and what Tab offers for types."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.interfaces import types_by_package

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add_kind_arguments(parser: argparse.ArgumentParser) -> None:
    """[-m] [-s] [-a]."""
    parser.add_argument("-m", "--only-msgs", action="store_true", help="only message types")
    parser.add_argument("-s", "--only-srvs", action="store_true", help="only service types")
    parser.add_argument("-a", "--only-actions", action="store_true", help="only action types")


def chosen(arguments: argparse.Namespace) -> list[str]:
    """The kinds that are asked for: all where none is named."""
    flags = {"msg": arguments.only_msgs, "srv": arguments.only_srvs, "action": arguments.only_actions}
    return [kind for kind, asked in flags.items() if asked] or list(flags)


def of_kind(names: list[str], kind: str) -> list[str]:
    """Of names such as `msg/String`, those of a kind."""
    return [name for name in names if name.startswith(f"{kind}/")]


def type_names(**_: object) -> list[str]:
    """The types that Tab offers."""
    return [f"{package}/{name}" for package, names in types_by_package().items() for name in names]


def package_names(**_: object) -> list[str]:
    """The packages that Tab offers."""
    return list(types_by_package())
