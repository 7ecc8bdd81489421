"""`ros2 run`: run a package's executable."""

from __future__ import annotations

import argparse
import shlex
import signal
import subprocess
from pathlib import Path

from tutor.bundled_ros import packages
from tutor.bundled_ros.ros2 import use_overlay
from tutor.bundled_ros.ros2.parsing import Verb, argument
from tutor.errors import CommandError

_LOG_PREFIX = "[ros2run]:"


def _run(arguments: argparse.Namespace) -> int:
    """Run the program to its end and return its exit code (-N after signal N). Raises CommandError."""
    use_overlay.overlay_workspace(Path.cwd())
    use_overlay.restore_buffering()
    command = [
        *shlex.split(arguments.prefix or ""),
        *_find_command(arguments.package, arguments.executable),
        *arguments.rest,
    ]
    # The terminal sends Ctrl+C to the program as well; we only have to outlive it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        program = subprocess.Popen(command, preexec_fn=_restore_sigint)
    except OSError as error:
        raise CommandError(f"{command[0]} cannot be started: {error.strerror}") from error
    signal.signal(signal.SIGTERM, lambda *_: program.terminate())
    code = program.wait()
    if code > 0:
        print(f"{_LOG_PREFIX} Process exited with failure {code}")
    elif code < 0:
        print(f"{_LOG_PREFIX} {signal.strsignal(-code)}")
    return code


def _find_command(package: str, executable: str) -> list[str]:
    try:
        return packages.find_executable(package, executable)
    except packages.PackageNotFound as error:
        raise CommandError(f"Package '{package}' not found{error.hint}") from error
    except packages.ExecutableNotFound as error:
        raise CommandError(f"No executable found{error.hint}") from error


def _complete_packages(**_: object) -> list[str]:
    """Complete packages that have executables."""
    use_overlay.overlay_workspace(Path.cwd())
    return packages.packages_with_executables()


def _complete_executables(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Complete the executables of the package that was typed."""
    use_overlay.overlay_workspace(Path.cwd())
    return packages.executable_names(parsed_args.package)


def _restore_sigint() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


GRAMMAR = {
    "run": Verb(
        _run,
        argument("--prefix", help="start the program with this command, in quotes"),
        argument("package", metavar="package_name", complete=_complete_packages, help="the package"),
        argument("executable", metavar="executable_name", complete=_complete_executables, help="its program"),
        argument("rest", metavar="argv", nargs=argparse.REMAINDER, help="what to pass to the program"),
    )
}
