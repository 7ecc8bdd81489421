"""`ros2 launch`: runs a launch file, named by its path or by a package and its file name."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from tutor.sandbox import packages
from tutor.sandbox.ros2 import overlaying
from tutor.sandbox.ros2.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[-s] PACKAGE FILE [NAME:=VALUE ...], or [-s] PATH [NAME:=VALUE ...]."""
    parser.add_argument(
        "-n", "--noninteractive", action="store_true", help="no terminal is there that passes Ctrl+C on to the nodes"
    )
    parser.add_argument("-d", "--debug", action="store_true", help="tell more of what launch does")
    parser.add_argument(
        "-s", "--show-args", "--show-arguments", action="store_true", help="show the arguments that the file takes"
    )
    parser.add_argument("package", metavar="package_name", help="a package, or the path of a launch file")
    parser.add_argument("file", metavar="launch_file_name", nargs="?", help="the launch file's name in the package")
    parser.add_argument(
        "arguments", metavar="launch_arguments", nargs="*", help="name:=value (of two of one name, the last counts)"
    )


def main(arguments: argparse.Namespace) -> int:
    """Launch, and give launch's own exit code. Raises CommandError."""
    overlaying.use(_place(arguments))
    given = list(arguments.arguments)
    if _by_path(arguments):
        path = Path(arguments.package)
        if arguments.file is not None:
            given.insert(0, arguments.file)
    else:
        path = _in_package(arguments.package, arguments.file)
    check_arguments(given)
    from tutor.sandbox import launching  # late: whoever only asks for help, or is wrong, needs none of it

    code: int = launching.run(
        path,
        given,
        show_args=arguments.show_args,
        noninteractive=arguments.noninteractive or None,
        debug=arguments.debug,
        resolver=packages,
    )
    return code


def check_arguments(given: Sequence[str]) -> None:
    """Raise CommandError where something is no launch argument."""
    for argument in given:
        name, sign, value = argument.partition(":=")
        if not (name and sign and value):
            raise CommandError(f"malformed launch argument '{argument}', expected format '<name>:=<value>'")


def _place(arguments: argparse.Namespace) -> Path:
    """Where to look for packages: the launch file, where one is named by its path; else the current folder."""
    named = Path(arguments.package)
    return Path(os.path.abspath(named)) if named.is_file() else Path.cwd()


def _by_path(arguments: argparse.Namespace) -> bool:
    """Whether the first word is a path: it is the only one that is no argument, or no package and there."""
    if arguments.file is not None and packages.has(arguments.package):
        return False
    if Path(arguments.package).is_file():
        return True
    if arguments.file is None or ":=" in arguments.file:
        if packages.has(arguments.package):
            raise CommandError(f"say which launch file of {arguments.package}: ros2 launch {arguments.package} FILE")
        raise CommandError(f"there is no launch file {arguments.package}")
    return False


def _in_package(package: str, name: str) -> Path:
    share = packages.find_share(package)
    found = []
    for folder, below, files in os.walk(share, followlinks=True):  # of a package that is not built, they are links
        below[:] = [each for each in below if not each.startswith((".", "__"))]
        if name in files:
            found.append(Path(folder) / name)
    if not found:
        raise CommandError(f"file '{name}' was not found in the share directory of package '{package}' ({share})")
    if len({path.resolve() for path in found}) > 1:
        listed = ", ".join(str(path) for path in found)
        raise CommandError(f"file '{name}' was found more than once in the share directory of '{package}': {listed}")
    return found[0].resolve()
