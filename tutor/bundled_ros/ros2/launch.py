"""`ros2 launch`: run a launch file, given by its path or by a package and a file name."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2 import use_overlay
from tutor.bundled_ros.ros2.parsing import OneOf, Verb, argument, flag
from tutor.bundled_ros.ros2.pkg.names import all_packages
from tutor.errors import CommandError
from tutor.ros.prefixes import entries

_LAUNCH_SUFFIXES = ("launch.py", "launch.xml", "launch.yaml", "launch.yml", ".launch")


def _launch(arguments: argparse.Namespace) -> int:
    """Run the launch file and return launch's own exit code. Raises CommandError."""
    use_overlay.overlay_workspace(_search_start(arguments))
    given = list(arguments.arguments)
    if _is_path(arguments):
        path = Path(arguments.package)
        if arguments.file is not None:
            given.insert(0, arguments.file)
    else:
        path = _find_in_package(arguments.package, arguments.file)
    check_arguments(given)
    if arguments.launch_prefix_filter is not None and arguments.launch_prefix is None:
        raise CommandError("--launch-prefix must be specified if --launch-prefix-filter is provided")
    for name in ("launch-prefix", "launch-prefix-filter"):
        if value := getattr(arguments, name.replace("-", "_")):
            given.append(f"{name}:={value}")
    if arguments.show_all_subprocesses_output:
        os.environ["OVERRIDE_LAUNCH_PROCESS_OUTPUT"] = "both"
    use_overlay.restore_buffering()
    from tutor.bundled_ros import launching  # late: --help and usage errors do not need it

    code: int = launching.run(
        path,
        given,
        show_args=arguments.show_args,
        show_description=arguments.print,
        noninteractive=arguments.noninteractive or None,
        debug=arguments.debug,
    )
    return code


def check_arguments(given: Sequence[str]) -> None:
    """Raise CommandError if a word is not a launch argument."""
    for word in given:
        name, sign, value = word.partition(":=")
        if not (name and sign and value):
            raise CommandError(f"malformed launch argument '{word}', expected format '<name>:=<value>'")


def _search_start(arguments: argparse.Namespace) -> Path:
    """Return where to start looking for packages: the launch file given by its path, or else the current folder."""
    named = Path(arguments.package)
    return Path(os.path.abspath(named)) if named.is_file() else Path.cwd()


def _is_path(arguments: argparse.Namespace) -> bool:
    """Return whether the first word is the launch file's path, not a package followed by a file name.

    Raises CommandError if it is neither.
    """
    if arguments.file is not None and packages.has_package(arguments.package):
        return False
    if Path(arguments.package).is_file():
        return True
    if arguments.file is None or ":=" in arguments.file:
        if packages.has_package(arguments.package):
            raise CommandError(f"say which launch file of {arguments.package}: ros2 launch {arguments.package} FILE")
        raise CommandError(f"there is no launch file {arguments.package}")
    return False


def _find_in_package(package: str, name: str) -> Path:
    try:
        share = packages.find_share(package)
    except packages.PackageNotFound as error:
        searched = entries(os.environ, "AMENT_PREFIX_PATH")
        message = f"Package '{package}' not found: \"package '{package}' not found, searching: {searched}\""
        raise CommandError(f"{message}{error.hint}") from error
    files = list(_files_below(share))
    found = [path for path in files if path.name == name]
    if not found:
        raise CommandError(
            f"file '{name}' was not found in the share directory of package '{package}' which is at '{share}'"
            + packages.hint(name, {path.name for path in files})
        )
    if len({path.resolve() for path in found}) > 1:
        listed = [str(path) for path in found]
        raise CommandError(
            f"file '{name}' was found more than once in the share directory of package '{package}': {listed}"
        )
    return found[0].resolve()


def _files_below(share: Path) -> Iterator[Path]:
    for folder, below, files in os.walk(share, followlinks=True):  # a package that is not built is made of links
        below[:] = [subfolder for subfolder in below if not subfolder.startswith((".", "__"))]
        yield from (Path(folder) / name for name in files)


def _complete_packages_and_files(prefix: str, **_: object) -> list[str]:
    """Complete packages, and the launch files and folders below the path typed so far."""
    parent, slash, _begun = prefix.rpartition("/")
    start = parent + slash
    paths = [] if start and not Path(start).is_dir() else sorted(Path(start or ".").iterdir())
    folders = [f"{start}{path.name}/" for path in paths if path.is_dir() and not path.name.startswith(".")]
    files = [f"{start}{path.name}" for path in paths if path.name.endswith(_LAUNCH_SUFFIXES)]
    return [*([] if slash else all_packages()), *files, *folders]


def _complete_files_of_package(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete the launch files of the package that was typed."""
    all_packages()
    try:
        share = packages.find_share(parsed_args.package)
    except packages.PackageNotFound:
        return []
    return sorted({path.name for path in _files_below(share) if path.name.endswith(_LAUNCH_SUFFIXES)})


def _complete_nothing(**_: object) -> list[str]:
    """Complete nothing: the shell must not offer file names where launch arguments belong."""
    return []


GRAMMAR = {
    "launch": Verb(
        _launch,
        flag("-n", "--noninteractive", help="no terminal is there that passes Ctrl+C on to the nodes"),
        flag("-d", "--debug", help="tell more of what launch does"),
        OneOf(
            flag("-p", "--print", "--print-description", help="show what the file describes, start nothing"),
            flag("-s", "--show-args", "--show-arguments", help="show the arguments that the file takes"),
        ),
        flag(
            "-a",
            "--show-all-subprocesses-output",
            help="show the output of all processes, and log it as well",
        ),
        argument("--launch-prefix", help="start every process with this command, in quotes"),
        argument("--launch-prefix-filter", help="only those whose name this regular expression matches"),
        argument(
            "package",
            metavar="package_name",
            complete=_complete_packages_and_files,
            help="a package, or the path of a launch file",
        ),
        argument(
            "file",
            metavar="launch_file_name",
            nargs="?",
            complete=_complete_files_of_package,
            help="the launch file's name in the package",
        ),
        argument(
            "arguments",
            metavar="launch_arguments",
            nargs="*",
            complete=_complete_nothing,
            help="name:=value (of two of one name, the last counts)",
        ),
    )
}
