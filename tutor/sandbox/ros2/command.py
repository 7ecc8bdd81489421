"""The command line of `ros2`: its verbs, and how it says what is wrong."""

from __future__ import annotations

import argparse
import atexit
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from tutor.sandbox.ros2 import launch, overlay, run
from tutor.sandbox.ros2.errors import CommandError

_VERBS: dict[str, tuple[str, Callable[[argparse.ArgumentParser], None], Callable[[argparse.Namespace], int]]] = {
    "launch": ("Run a launch file", launch.add_arguments, launch.main),
    "run": ("Run a package specific executable", run.add_arguments, run.main),
}
_ELSEWHERE = (
    "action bag component control daemon doctor interface lifecycle multicast node param pkg security service topic wtf"
)
_OVERLAY = "ROS_TUTOR_OVERLAY"


def main(argv: Sequence[str]) -> int:
    """Run `ros2 ARGV...`; gives its exit code. What is wrong is told in one line on stderr."""
    if argv and not argv[0].startswith("-") and argv[0] not in _VERBS:
        return _say(_unknown(argv[0]), 2)
    parser = argparse.ArgumentParser(prog="ros2", description="ros2, as far as the exercises need it.")
    verbs = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, (help, add_arguments, run_verb) in _VERBS.items():
        verb = verbs.add_parser(name, help=help, description=help)
        add_arguments(verb)
        verb.set_defaults(run=run_verb, near=_place_of(argv))
    arguments = parser.parse_args(argv)
    _use_overlay(arguments.near)
    try:
        code: int = arguments.run(arguments)
    except (CommandError, LookupError) as error:
        return _say(str(error), 1)
    except KeyboardInterrupt:
        return 130
    return code


def _place_of(argv: Sequence[str]) -> Path:
    """Where to look for packages: the launch file, where one is named by its path; else the current folder."""
    named = next((Path(word) for word in argv[1:] if not word.startswith("-")), None)
    is_file = argv[:1] == ["launch"] and named is not None and named.is_file()
    return Path(os.path.abspath(named)) if is_file and named is not None else Path.cwd()


def _use_overlay(near: Path) -> None:
    """Have the packages found that are there as sources only, by us and by what we start."""
    if Path(os.environ.get(_OVERLAY, "/nowhere")).is_dir():
        return  # of the `ros2` that started us
    logs = os.environ.get("ROS_LOG_DIR")  # a check's is a folder of its own, which goes when the check is over
    folder = Path(tempfile.mkdtemp(prefix="ros2-overlay-", dir=logs if logs and Path(logs).is_dir() else None))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    try:
        overlay.make(folder / "prefix", near, os.environ)
    except OSError as error:
        raise CommandError(f"the packages cannot be read: {error}") from error
    os.environ[_OVERLAY] = str(folder / "prefix")


def _unknown(verb: str) -> str:
    if verb in _ELSEWHERE.split():
        return f"`ros2 {verb}` needs an installed ROS 2; this ros2 knows: {', '.join(_VERBS)}"
    return f"there is no command '{verb}' (this ros2 knows: {', '.join(_VERBS)})"


def _say(text: str, code: int) -> int:
    print(f"ros2: {text}", file=sys.stderr)
    return code
