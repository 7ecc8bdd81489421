"""`ros2 interface packages`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.interface.kinds import KINDS, add_kind_arguments, filter_by_kind, selected_kinds
from tutor.ros.interfaces import types_by_package


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-m] [-s] [-a]."""
    add_kind_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the packages that have types of the selected kinds."""
    kinds = selected_kinds(arguments)
    kinds = kinds if len(kinds) == len(KINDS) else kinds[:1]  # like ros2cli, which uses only the first of two
    for package, names in types_by_package().items():
        if any(filter_by_kind(names, kind) for kind in kinds):
            print(package)
