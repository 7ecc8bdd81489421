"""`ros2 interface list`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.interface.kinds import KINDS, add_kind_arguments, filter_by_kind, selected_kinds
from tutor.ros.interfaces import types_by_package


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-m] [-s] [-a]."""
    add_kind_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print all types, by kind."""
    found = types_by_package()
    for kind in selected_kinds(arguments):
        print(f"{KINDS[kind]}:")
        for package, names in found.items():
            for name in sorted(filter_by_kind(names, kind)):
                print(f"    {package}/{name}")
