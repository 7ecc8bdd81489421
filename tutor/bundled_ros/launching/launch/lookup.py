"""Substitutions that look something up: launch configurations, the environment, paths, files, commands."""

from __future__ import annotations

import os
import os.path
import random
import re
import shlex
import shutil
import socket
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeSubstitutionsType, Substitution
from tutor.bundled_ros.launching.launch.logs import get_logger, launch_config
from tutor.bundled_ros.launching.launch.text import SUBSTITUTIONS
from tutor.bundled_ros.launching.launch.values import (
    SubstitutionFailure,
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LaunchConfiguration(Substitution):
    """The value of a launch argument or of SetLaunchConfiguration; `default` if it is not set."""

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(variable_name)
        self._default = None if default is None else normalize_to_list_of_substitutions(_texts(default))

    def describe(self) -> str:
        return f"LaunchConfig({' + '.join(part.describe() for part in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self._name)
        if name in context.launch_configurations:
            return context.launch_configurations[name]  # type: ignore[no-any-return]  # a list, for some of launch_ros
        if self._default is None:
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist")
        return perform_substitutions(context, self._default)


def _texts(default: Any) -> list[str | Substitution]:
    """Convert a default, which may be any value or several, to texts and substitutions."""
    items = [default] if isinstance(default, str) or not isinstance(default, Iterable) else list(default)
    return [item if isinstance(item, str | Substitution) else str(item) for item in items]


class EnvironmentVariable(Substitution):
    """A variable of the launch's environment, or the default if it is not set."""

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    def describe(self) -> str:
        return f"EnvVar({' + '.join(part.describe() for part in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        default = None if self._default is None else perform_substitutions(context, self._default)
        name = perform_substitutions(context, self._name)
        value = context.environment.get(name, default)
        if value is None:
            raise SubstitutionFailure(f"environment variable '{name}' does not exist")
        return value


class LocalSubstitution(Substitution):
    """An expression on the locals, such as `event.reason`."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        ensure_argument_type(expression, str, "expression", "LocalSubstitution")
        self._expression = expression
        self._description = description

    def describe(self) -> str:
        return f"LocalVar('{self._expression if self._description is None else self._description}')"

    def perform(self, context: LaunchContext) -> str:
        value: str = eval("locals_of_context." + self._expression, {"locals_of_context": context.locals})
        return value


class AnonName(Substitution):
    """The name with a unique suffix, which is the same throughout a launch."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    def describe(self) -> str:
        return f"AnonName({' + '.join(item.describe() for item in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self._name)
        unique = f"{name}_{socket.gethostname()}_{os.getpid()}_{random.getrandbits(63)}"
        found: str = context.launch_configurations.setdefault(f"anon{name}", re.sub(r"[.:-]", "_", unique))
        return found


class PathJoinSubstitution(Substitution):
    """Parts joined as by os.path.join, each a text, a path, a substitution or several of these.

    `path / part` appends a part.
    """

    def __init__(self, substitutions: SomeSubstitutionsType | Iterable[SomeSubstitutionsType]) -> None:
        parts = [substitutions] if isinstance(substitutions, str | Path | Substitution) else substitutions
        self._parts = [normalize_to_list_of_substitutions(part) for part in parts]

    @property
    def substitutions(self) -> list[Substitution]:
        return [item for part in self._parts for item in part]

    def describe(self) -> str:
        return f"PathJoin('{' + '.join(item.describe() for item in self.substitutions)}')"

    def perform(self, context: LaunchContext) -> str:
        return os.path.join(*[perform_substitutions(context, part) for part in self._parts])

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self._parts, additional_path])


class PathSubstitution(PathJoinSubstitution):
    """A path to which parts can be appended: `PathSubstitution(FindPackageShare('demo')) / 'config' / 'x.yaml'`."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])


class FoundPath(PathSubstitution):
    """Base class of substitutions that find a folder."""

    def __init__(self) -> None:
        super().__init__(self)


class ThisLaunchFile(Substitution):
    """The launch file that was included last."""

    def describe(self) -> str:
        return "ThisLaunchFile()"

    def perform(self, context: LaunchContext) -> str:
        path: str | None = context.get_locals_as_dict().get("current_launch_file_path")
        if path is None:
            raise SubstitutionFailure("ThisLaunchFile used outside of a launch file (in a script)")
        return path


class ThisLaunchFileDir(FoundPath):
    """The folder of the launch file that was included last."""

    def describe(self) -> str:
        return "ThisLaunchFileDir()"

    def perform(self, context: LaunchContext) -> str:
        folder: str | None = context.get_locals_as_dict().get("current_launch_file_directory")
        if folder is None:
            raise SubstitutionFailure("ThisLaunchFileDir used outside of a launch file (in a script)")
        return folder


class LaunchLogDir(FoundPath):
    """The log folder of this launch and its processes."""

    def describe(self) -> str:
        return "LaunchLogDir()"

    def perform(self, context: LaunchContext) -> str:
        return launch_config.log_dir


class FindExecutable(Substitution):
    """The path of a command on PATH."""

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    def describe(self) -> str:
        return f"FindExec({' + '.join(part.describe() for part in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self._name)
        found = shutil.which(name)
        if found is None:
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH")
        return found


class FileContent(Substitution):
    """The content of a text file."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self._path = normalize_to_list_of_substitutions(path)

    def describe(self) -> str:
        return f"FileContent({', '.join(part.describe() for part in self._path)})"

    def perform(self, context: LaunchContext) -> str:
        path = perform_substitutions(context, self._path)
        try:
            return Path(path).read_text()
        except FileNotFoundError as error:
            raise SubstitutionFailure(f"File not found: {path}") from error


class Command(Substitution):
    """The output of a command. Fails if the command fails or, depending on `on_stderr`, if it prints to stderr."""

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self._command = normalize_to_list_of_substitutions(command)
        self._on_stderr = normalize_to_list_of_substitutions(on_stderr)

    def describe(self) -> str:
        return f"Command({' + '.join(part.describe() for part in self._command)})"

    def perform(self, context: LaunchContext) -> str:
        command = perform_substitutions(context, self._command)
        on_stderr = perform_substitutions(context, self._on_stderr)
        if on_stderr not in ("fail", "ignore", "warn", "capture"):
            raise SubstitutionFailure("expected 'on_stderr' to be one of: 'fail', 'ignore', 'warn' or 'capture'")
        stderr = subprocess.STDOUT if on_stderr == "capture" else subprocess.PIPE
        try:
            done = subprocess.run(shlex.split(command), stdout=subprocess.PIPE, stderr=stderr, text=True, check=False)
        except FileNotFoundError as error:
            raise SubstitutionFailure(f"file not found: {error}") from error
        if done.returncode != 0:
            shown = f"\nCaptured stderr output: {done.stderr}" if done.stderr else ""
            raise SubstitutionFailure(f"executed command failed. Command: {command}{shown}")
        if done.stderr:
            message = (
                f"executed command showed stderr output. Command: {command}\nCaptured stderr output:\n{done.stderr}"
            )
            if on_stderr == "fail":
                raise SubstitutionFailure(message)
            if on_stderr == "warn":
                get_logger().warning(message)
        return done.stdout


SUBSTITUTIONS |= {
    "anon": (1, 1, AnonName),
    "command": (1, 2, lambda command, on_stderr="fail": Command(command, on_stderr=on_stderr)),
    "dirname": (0, 0, ThisLaunchFileDir),
    "env": (1, 2, lambda name, default=None: EnvironmentVariable(name, default_value=default)),
    "file-content": (1, 1, FileContent),
    "filename": (0, 0, ThisLaunchFile),
    "find-exec": (1, 1, lambda name: FindExecutable(name=name)),
    "launch_log_dir": (0, 0, LaunchLogDir),
    "log_dir": (0, 0, LaunchLogDir),
    "var": (1, 2, lambda name, default=None: LaunchConfiguration(name, default=default)),
}
