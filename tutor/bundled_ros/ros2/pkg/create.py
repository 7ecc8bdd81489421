"""`ros2 pkg create`: make the files of a new package, the same ones as the real command."""

from __future__ import annotations

import argparse
import getpass
import os
import shutil
import subprocess
import sys

from tutor.bundled_ros.ros2.parsing import Verb, argument
from tutor.bundled_ros.ros2.pkg.creation import BUILD_TYPES, Folder, NewPackage, Note, contents, licenses
from tutor.bundled_ros.ros2.pkg.names import complete_packages
from tutor.errors import CommandError

_LIST_LICENSES = "?"


def _create(arguments: argparse.Namespace) -> None:
    """Create the package and print each step. Raises CommandError if it exists or cannot be written."""
    if arguments.license == _LIST_LICENSES:
        print("Supported licenses:", *licenses.NAMES, sep="\n")
        return
    package = _describe(arguments)
    if package.build_type == "ament_python" and package.name == "test":
        raise CommandError(
            "Aborted since 'ament_python' packages can't be named 'test'. Please choose a different package name."
        )
    root = os.path.join(arguments.destination_directory, package.name)
    if os.path.exists(root):
        raise CommandError(
            f"\nAborted!\nThe directory already exists: {root}\n"
            "Either remove the directory or choose a different destination directory or package name"
        )
    _print_summary(package, os.path.abspath(arguments.destination_directory))
    try:
        _write(package, root)
    except OSError as error:
        raise CommandError(f"cannot create {error.filename or root}: {error.strerror}") from error
    if licenses.text_of(package.license) is None:
        print(
            f"\n[WARNING]: Unknown license '{package.license}'.  This has been set in the package.xml, but no LICENSE "
            "file has been created.\nIt is recommended to use one of the ament license identifiers:",
            *licenses.NAMES,
            sep="\n",
        )


def _describe(arguments: argparse.Namespace) -> NewPackage:
    node = arguments.node_name or ""
    library = arguments.library_name or ""
    maintainer = _user_name() if arguments.maintainer_name is None else arguments.maintainer_name
    email = arguments.maintainer_email or _email_from_git() or f"{maintainer}@todo.todo"
    if node and node == library:
        node += "_node"
        print("[WARNING] node name can not be equal to the library name", file=sys.stderr)
        print(f"[WARNING] renaming node to {node}", file=sys.stderr)
    return NewPackage(
        name=arguments.package_name,
        build_type=arguments.build_type,
        format=arguments.package_format,
        description=arguments.description,
        license=arguments.license,
        maintainer=maintainer,
        email=email,
        dependencies=tuple(arguments.dependencies),
        node=node,
        library=library,
    )


def _print_summary(package: NewPackage, destination: str) -> None:
    print("going to create a new package")
    print(f"package name: {package.name}")
    print(f"destination directory: {destination}")
    print(f"package format: {package.format}")
    print(f"version: {package.version}")
    print(f"description: {package.description}")
    print(f"maintainer: {[f'{package.maintainer} <{package.email}>']}")
    print(f"licenses: {[package.license]}")
    print(f"build type: {package.build_type}")
    print(f"dependencies: {list(package.dependencies)}")
    if package.node:
        print(f"node_name: {package.node}")
    if package.library:
        print(f"library_name: {package.library}")


def _write(package: NewPackage, root: str) -> None:
    for entry in contents(package):
        if isinstance(entry, Note):
            print(entry.text)
            continue
        path = os.path.join(root, entry.path) if entry.path else root
        if isinstance(entry, Folder):
            print("creating folder", path)
            os.makedirs(path, exist_ok=True)
            continue
        print("creating", path)
        os.makedirs(os.path.dirname(path), exist_ok=True)  # a name may have a "/" in it
        with open(path, "w", encoding="utf-8") as file:
            file.write(entry.text)
    if (text := licenses.text_of(package.license)) is not None:
        with open(os.path.join(root, "LICENSE"), "w", encoding="utf-8") as file:
            file.write(text)


def _email_from_git() -> str:
    """Return the user's address as git knows it here; empty if it knows none."""
    git = shutil.which("git")
    if git is None:
        return ""
    answer = subprocess.run([git, "config", "user.email"], stdout=subprocess.PIPE, check=False)
    return answer.stdout.decode(errors="replace").rstrip()


def _user_name() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError):  # a user id without a name, as in some containers
        return "user"


def _complete_licenses(**_: object) -> list[str]:
    return list(licenses.NAMES)


GRAMMAR = {
    "create": Verb(
        _create,
        argument("package_name", help="the name of the new package"),
        argument(
            "--package-format",
            "--package_format",
            type=int,
            default=3,
            choices=[2, 3],
            help="the format of package.xml (default: 3)",
        ),
        argument("--description", default="TODO: Package description", help="what the package is for"),
        argument(
            "--license",
            default="TODO: License declaration",
            complete=_complete_licenses,
            help=f"any text; for a known license, its LICENSE file is added ('{_LIST_LICENSES}' lists these)",
        ),
        argument("--destination-directory", default=os.curdir, help="where to put the package's folder"),
        argument(
            "--build-type", default="ament_cmake", choices=BUILD_TYPES, help="what builds it (default: ament_cmake)"
        ),
        argument("--dependencies", nargs="+", default=[], complete=complete_packages, help="packages that it needs"),
        argument("--maintainer-email", help="the maintainer's address (default: the one that git knows)"),
        argument("--maintainer-name", help="the maintainer's name (default: yours)"),
        argument("--node-name", help="add a program of this name, which only prints a line"),
        argument("--library-name", help="add an empty library of this name"),
    )
}
