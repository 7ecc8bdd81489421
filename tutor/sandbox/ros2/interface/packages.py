"""`ros2 interface packages`."""

from __future__ import annotations

import argparse

from tutor.sandbox.ros2.interface.kinds import add_kind_arguments, chosen, of_kind
from tutor.sandbox.ros2.interfaces import interfaces


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-m] [-s] [-a]."""
    add_kind_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print the packages that have types, of these kinds."""
    for package, names in interfaces().items():
        if any(of_kind(names, kind) for kind in chosen(arguments)):
            print(package)
