"""`ros2 pkg`."""

from __future__ import annotations

import argparse
from pathlib import Path

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs, argument, flag
from tutor.bundled_ros.ros2.pkg.names import all_packages, complete_packages
from tutor.errors import CommandError


def _list(_: argparse.Namespace) -> None:
    """Print the packages."""
    for name in all_packages():
        print(name)


def _executables(arguments: argparse.Namespace) -> None:
    """Print the executables. Raises CommandError if there is no such package."""
    known = all_packages()
    wanted = arguments.package_name
    if wanted is not None and wanted not in known:
        raise CommandError(f"Package '{wanted}' not found")
    for package in known if wanted is None else [wanted]:
        for name, path in sorted(packages.executables_of(package).items()):
            print(path if arguments.full_path else f"{package} {name}")


def _prefix(arguments: argparse.Namespace) -> None:
    """Print the package's folder. Raises CommandError if there is no such package."""
    share = _find_share(arguments.package_name)
    source = (share / "package.xml").resolve().parent
    if source != share.resolve():  # an unbuilt package: its prefix is temporary and made of links
        print(source)
    else:
        print(share if arguments.share else share.parent.parent)


def _xml(arguments: argparse.Namespace) -> None:
    """Print package.xml or the text of one of its tags. Raises CommandError if that does not exist."""
    import xml.etree.ElementTree as ET

    file = _find_share(arguments.package_name) / "package.xml"
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


def _find_share(package: str) -> Path:
    all_packages()
    try:
        return packages.find_share(package)
    except packages.PackageNotFound as error:
        raise CommandError("Package not found") from error


_PACKAGE = argument("package_name", complete=complete_packages, help="the package")
_VERBS: Verbs = {
    "create": ("Make a new package", "pkg.create"),
    "executables": (
        "List the programs of a package, or of all",
        Verb(
            _executables,
            argument("package_name", nargs="?", complete=complete_packages, help="only of this package"),
            flag("--full-path", help="the path of each"),
        ),
    ),
    "list": ("List the packages", Verb(_list)),
    "prefix": ("Show where a package is", Verb(_prefix, _PACKAGE, flag("--share", help="the folder of its files"))),
    "xml": (
        "Show a package's package.xml",
        Verb(_xml, _PACKAGE, argument("-t", "--tag", help="only what this tag holds, such as version")),
    ),
}
GRAMMAR = {"pkg": Group(_VERBS)}
