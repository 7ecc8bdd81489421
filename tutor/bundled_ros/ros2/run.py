"""`ros2 run`: starts a program of a package."""

from __future__ import annotations

import argparse
import shlex
import signal
import subprocess
from pathlib import Path

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2 import overlaying
from tutor.bundled_ros.ros2.parsing import complete_with
from tutor.errors import CommandError

_SAYS = "[ros2run]:"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--prefix COMMAND] PACKAGE EXECUTABLE [ARGUMENT ...]."""
    parser.add_argument("--prefix", help="start the program with this command, in quotes")
    complete_with(parser.add_argument("package", metavar="package_name", help="the package"), _packages)
    complete_with(parser.add_argument("executable", metavar="executable_name", help="its program"), _programs)
    parser.add_argument("rest", metavar="argv", nargs=argparse.REMAINDER, help="what to pass to the program")


def main(arguments: argparse.Namespace) -> int:
    """Run the program to its end, and give its exit code (-N after signal N). Raises CommandError."""
    overlaying.overlay_workspace(Path.cwd())
    overlaying.restore_buffering()
    command = [*shlex.split(arguments.prefix or ""), *_find(arguments.package, arguments.executable), *arguments.rest]
    # Ctrl+C reaches the program by itself; we only have to be there still when it has ended.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        program = subprocess.Popen(command, preexec_fn=_as_from_a_terminal)
    except OSError as error:
        raise CommandError(f"{command[0]} cannot be started: {error.strerror}") from error
    signal.signal(signal.SIGTERM, lambda *_: program.terminate())
    code = program.wait()
    if code > 0:
        print(f"{_SAYS} Process exited with failure {code}")
    elif code < 0:
        print(f"{_SAYS} {signal.strsignal(-code)}")
    return code


def _find(package: str, executable: str) -> list[str]:
    try:
        return packages.find_executable(package, executable)
    except packages.PackageNotFound as error:
        raise CommandError(f"Package '{package}' not found{error.hint}") from error
    except packages.ExecutableNotFound as error:
        raise CommandError(f"No executable found{error.hint}") from error


def _packages(**_: object) -> list[str]:
    """For Tab: the packages that have programs."""
    overlaying.overlay_workspace(Path.cwd())
    return packages.packages_with_programs()


def _programs(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """For Tab: the programs of the package that was typed."""
    overlaying.overlay_workspace(Path.cwd())
    return packages.programs_of(parsed_args.package)


def _as_from_a_terminal() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)
