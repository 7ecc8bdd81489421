"""`ros2 interface package`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.interface.kinds import add_kind_arguments, filter_by_kind, package_names, selected_kinds
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.errors import CommandError
from tutor.ros.interfaces import types_by_package


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-m] [-s] [-a] PACKAGE."""
    add_kind_arguments(parser)
    complete_with(parser.add_argument("package_name", help="the package, such as std_msgs"), package_names)


def main(arguments: argparse.Namespace) -> None:
    """Print the types of a package. Raises CommandError if there is no such package."""
    from tutor.bundled_ros import packages

    package = arguments.package_name
    names = types_by_package().get(package)
    if names is None and not packages.has_package(package):
        raise CommandError(f"Unknown package '{package}'")
    for kind in selected_kinds(arguments):
        for name in filter_by_kind(names or [], kind):
            print(f"{package}/{name}")
