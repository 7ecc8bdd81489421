"""Runs one launch file in this process, as `ros2 launch` does."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from tutor.bundled_ros import packages

SUBSTITUTES = Path(__file__).parent / "site"
"""The folder of the `launch` and `launch_ros` that stand in for the real ones."""


class Resolver(Protocol):
    """Finds packages; LookupError with a message for users where there is none."""

    def find_executable(self, package: str, executable: str) -> list[str]:
        """The words of the command that runs a package's executable."""

    def find_share(self, package: str) -> Path:
        """A package's share folder."""


def has_real_launch() -> bool:
    """Whether a real `launch` is installed. A mere folder of that name on the path does not count."""
    spec = importlib.util.find_spec("launch")
    return spec is not None and spec.origin is not None and Path(spec.origin).parent != SUBSTITUTES / "launch"


def run(
    path: Path | str,
    arguments: Sequence[str] | Mapping[str, str] = (),
    show_args: bool = False,
    *,
    show_description: bool = False,
    noninteractive: bool | None = None,
    debug: bool = False,
    resolver: Resolver = packages,
) -> int:
    """Run the launch file, or only print its arguments, or all that it describes.

    Returns the exit code: 0, or 1 after an error.

    `arguments`: `name:=value`, or a mapping. `noninteractive`: no terminal passes Ctrl+C on to the nodes;
    found out where it is not given. `resolver` serves the substitutes only: a real launch finds packages by itself.
    """
    try:
        pairs = list(arguments.items()) if isinstance(arguments, Mapping) else _pairs(arguments)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    launch = _import_launch(resolver)
    try:
        if show_args or show_description:
            return _show(launch, path, _show_arguments if show_args else _show_description)
        if noninteractive is None:
            noninteractive = not sys.stdin.isatty()
        argv = [f"{name}:={value}" for name, value in pairs]
        return _launch(launch, path, pairs, argv, noninteractive=noninteractive, debug=debug)
    except KeyboardInterrupt:
        return 130


def _pairs(arguments: Sequence[str]) -> list[tuple[str, str]]:
    """Names and values, the last value of each name; ValueError where one is malformed."""
    values: dict[str, str] = {}
    for argument in arguments:
        name, sign, value = argument.partition(":=")
        if not sign or not name or not value:
            raise ValueError(f"malformed launch argument '{argument}', expected format '<name>:=<value>'")
        values[name] = value
    return list(values.items())


def _import_launch(resolver: Resolver) -> Any:
    if has_real_launch():
        return importlib.import_module("launch")
    if str(SUBSTITUTES) not in sys.path:
        sys.path.append(str(SUBSTITUTES))
    launch = importlib.import_module("launch")
    importlib.import_module("launch_ros.packages").resolver = resolver  # type: ignore[attr-defined]
    return launch


def _launch(
    launch: Any,
    path: Path | str,
    pairs: list[tuple[str, str]],
    argv: list[str],
    *,
    noninteractive: bool,
    debug: bool,
) -> int:
    sources = importlib.import_module("launch.launch_description_sources")
    actions = importlib.import_module("launch.actions")
    source = sources.AnyLaunchDescriptionSource(str(path))
    include = actions.IncludeLaunchDescription(source, launch_arguments=pairs)
    service = launch.LaunchService(argv=argv, noninteractive=noninteractive, debug=debug)
    service.include_launch_description(launch.LaunchDescription([include]))
    code: int = service.run()
    return code


def _show(launch: Any, path: Path | str, show: Callable[[Any, Any], None]) -> int:
    sources = importlib.import_module("launch.launch_description_sources")
    try:
        description = sources.get_launch_description_from_any_launch_file(str(path))
    except Exception as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        _show_learners_part(error)
        return 1
    show(launch, description)
    return 0


def _show_description(launch: Any, description: Any) -> None:
    print(launch.LaunchIntrospector().format_launch_description(description))


def _show_arguments(launch: Any, description: Any) -> None:
    print("Arguments (pass arguments as '<name>:=<value>'):")
    declared = description.get_launch_arguments()
    for argument in declared:
        print(f"\n    '{argument.name}':{'*' if argument._conditionally_included else ''}")
        print(f"        {argument.description}")
        if argument.default_value is not None:
            print(f"        (default: {' + '.join(part.describe() for part in argument.default_value)})")
    if not declared:
        print("\n  No arguments.")
    elif any(argument._conditionally_included for argument in declared):
        print("\n* argument(s) which are only used if specific conditions occur")
    _show_unreadable()


def _show_unreadable() -> None:
    """Say which included files could not be read: what they declare is not in the list."""
    unreadable = getattr(importlib.import_module("launch.launch_description_source"), "unreadable", {})
    for path, error in unreadable.items():
        cause = error.__cause__ or error
        print(f"the arguments of {path} are missing: {type(cause).__name__}: {cause}", file=sys.stderr)


def _show_learners_part(error: Exception) -> None:
    with contextlib.suppress(ImportError):
        shown = importlib.import_module("launch._tracebacks").of_learner(error)
        if shown is not None:
            print(shown, file=sys.stderr)
