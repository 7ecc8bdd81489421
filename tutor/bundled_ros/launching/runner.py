"""Run one launch file in this process, as `ros2 launch` does."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any


def has_real_launch() -> bool:
    """Return whether a real `launch` is installed. A folder that merely has this name does not count."""
    spec = importlib.util.find_spec("launch")
    return spec is not None and spec.origin is not None


def run(
    path: Path | str,
    arguments: Sequence[str] | Mapping[str, str] = (),
    show_args: bool = False,
    *,
    show_description: bool = False,
    noninteractive: bool | None = None,
    debug: bool = False,
) -> int:
    """Run the launch file, or only print its arguments or its description.

    Returns the exit code: 0, 1 after an error, or 130 after a Ctrl+C that the launch itself did not handle.

    `arguments` are `name:=value` words or a mapping. `noninteractive` means that no terminal sends Ctrl+C to the nodes
    (None: if stdin is not a terminal).
    """
    try:
        pairs = list(arguments.items()) if isinstance(arguments, Mapping) else _parse_arguments(arguments)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    launch = _import_launch()
    try:
        if show_args or show_description:
            return _show(launch, path, _show_arguments if show_args else _show_description)
        if noninteractive is None:
            noninteractive = not sys.stdin.isatty()
        argv = [f"{name}:={value}" for name, value in pairs]
        return _launch(launch, path, pairs, argv, noninteractive=noninteractive, debug=debug)
    except KeyboardInterrupt:
        return 130


def _parse_arguments(arguments: Sequence[str]) -> list[tuple[str, str]]:
    """Parse `name:=value` words; the last value of a name wins. Raises ValueError for a malformed word."""
    values: dict[str, str] = {}
    for argument in arguments:
        name, sign, value = argument.partition(":=")
        if not sign or not name or not value:
            raise ValueError(f"malformed launch argument '{argument}', expected format '<name>:=<value>'")
        values[name] = value
    return list(values.items())


def _import_launch() -> Any:
    if not has_real_launch():
        install_substitutes()
    return importlib.import_module("launch")


def install_substitutes() -> None:
    """Make our substitutes importable as `launch` and `launch_ros`, with the tags of XML and YAML files."""
    from tutor.bundled_ros.launching import real_names
    from tutor.bundled_ros.launching.launch import tags as launch_tags  # noqa: F401 - registers them
    from tutor.bundled_ros.launching.launch_ros import tags as ros_tags  # noqa: F401

    real_names.install()


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
        _print_learner_traceback(error)
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
    _print_unreadable()


def _print_unreadable() -> None:
    """Report included files that could not be read: their arguments are missing from the list."""
    if has_real_launch():
        return
    from tutor.bundled_ros.launching.launch.description import unreadable

    for path, error in unreadable.items():
        cause = error.__cause__ or error
        print(f"the arguments of {path} are missing: {type(cause).__name__}: {cause}", file=sys.stderr)


def _print_learner_traceback(error: Exception) -> None:
    if has_real_launch():
        return
    from tutor.bundled_ros.launching.launch.errors import of_learner

    text = of_learner(error)
    if text is not None:
        print(text, file=sys.stderr)
