"""Selecting messages, services or actions, and the tab completion of types and packages."""

from __future__ import annotations

import argparse

from tutor.ros.interfaces import types_by_package

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add_kind_arguments(parser: argparse.ArgumentParser) -> None:
    """Add [-m] [-s] [-a]."""
    parser.add_argument("-m", "--only-msgs", action="store_true", help="only message types")
    parser.add_argument("-s", "--only-srvs", action="store_true", help="only service types")
    parser.add_argument("-a", "--only-actions", action="store_true", help="only action types")


def selected_kinds(arguments: argparse.Namespace) -> list[str]:
    """Return the kinds that were selected; all if none was."""
    flags = {"msg": arguments.only_msgs, "srv": arguments.only_srvs, "action": arguments.only_actions}
    return [kind for kind, is_selected in flags.items() if is_selected] or list(flags)


def filter_by_kind(names: list[str], kind: str) -> list[str]:
    """Filter names such as `msg/String` by their kind."""
    return [name for name in names if name.startswith(f"{kind}/")]


def package_names(**_: object) -> list[str]:
    """Complete packages that have types."""
    return list(types_by_package())
