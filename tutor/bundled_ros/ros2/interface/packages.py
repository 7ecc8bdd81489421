"""`ros2 interface packages`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.interface.kinds import KINDS, add_kind_arguments, chosen, of_kind
from tutor.bundled_ros.ros2.interfaces import types_by_package


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-m] [-s] [-a]."""
    add_kind_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the packages that have types, of these kinds."""
    kinds = chosen(arguments)
    kinds = kinds if len(kinds) == len(KINDS) else kinds[:1]  # of several, ros2cli takes the first
    for package, names in types_by_package().items():
        if any(of_kind(names, kind) for kind in kinds):
            print(package)
