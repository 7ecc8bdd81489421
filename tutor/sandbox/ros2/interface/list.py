"""`ros2 interface list`."""

from __future__ import annotations

import argparse

from tutor.sandbox.ros2.interface.kinds import KINDS, add_kind_arguments, chosen, of_kind
from tutor.sandbox.ros2.interfaces import interfaces


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-m] [-s] [-a]."""
    add_kind_arguments(parser)


def main(arguments: argparse.Namespace) -> None:
    """Print all types, by kind."""
    found = interfaces()
    for kind in chosen(arguments):
        print(f"{KINDS[kind]}:")
        for package, names in found.items():
            for name in sorted(of_kind(names, kind)):
                print(f"    {package}/{name}")
