"""`ros2 pkg prefix`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.pkg.names import all_packages, package_names
from tutor.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--share] PACKAGE."""
    complete_with(parser.add_argument("package_name", help="the package"), package_names)
    parser.add_argument("--share", action="store_true", help="the folder of its files")


def main(arguments: argparse.Namespace) -> None:
    """Print the package's folder. Raises CommandError if there is no such package."""
    all_packages()
    try:
        share = packages.find_share(arguments.package_name)
    except packages.PackageNotFound as error:
        raise CommandError("Package not found") from error
    source = (share / "package.xml").resolve().parent
    if source != share.resolve():  # an unbuilt package: its prefix is temporary and made of links
        print(source)
    else:
        print(share if arguments.share else share.parent.parent)
