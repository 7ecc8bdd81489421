"""`ros2 pkg executables`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.pkg.names import all_packages, package_names
from tutor.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--full-path] [PACKAGE]."""
    complete_with(parser.add_argument("package_name", nargs="?", help="only of this package"), package_names)
    parser.add_argument("--full-path", action="store_true", help="the path of each")


def main(arguments: argparse.Namespace) -> None:
    """Print the executables. Raises CommandError if there is no such package."""
    known = all_packages()
    wanted = arguments.package_name
    if wanted is not None and wanted not in known:
        raise CommandError(f"Package '{wanted}' not found")
    for package in known if wanted is None else [wanted]:
        for name, path in sorted(packages.executables_of(package).items()):
            print(path if arguments.full_path else f"{package} {name}")
