"""`ros2 pkg xml`."""

from __future__ import annotations

import argparse
import xml.etree.ElementTree as ET

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.bundled_ros.ros2.pkg.names import all_packages, package_names
from tutor.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-t TAG] PACKAGE."""
    complete_with(parser.add_argument("package_name", help="the package"), package_names)
    parser.add_argument("-t", "--tag", help="only what this tag holds, such as version")


def main(arguments: argparse.Namespace) -> None:
    """Print package.xml or the text of one of its tags. Raises CommandError if that does not exist."""
    all_packages()
    try:
        file = packages.find_share(arguments.package_name) / "package.xml"
    except packages.PackageNotFound as error:
        raise CommandError("Package not found") from error
    if not file.is_file():
        raise CommandError("Package XML manifest not found")
    try:
        tree = ET.parse(file)
    except ET.ParseError as error:
        raise CommandError(f"{file} is not XML: {error}") from error
    if arguments.tag is None:
        ET.dump(tree)
        return
    elements = tree.getroot().findall(arguments.tag)
    if not elements:
        raise CommandError("XML tag not found")
    for element in elements:
        print(element.text)
