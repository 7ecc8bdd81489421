"""The substitutions by the names that they have in XML and YAML."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from .. import substitutions as subs
from ..substitution import Substitution
from ..substitutions.text_substitution import TextSubstitution

Argument = list[Substitution]


def _python(expression: Argument, modules: Argument | None = None) -> Substitution:
    if modules is None:
        return subs.PythonExpression(expression)
    named = "".join(part.text for part in modules if isinstance(part, TextSubstitution))
    return subs.PythonExpression(expression, [name.strip() for name in named.split(",") if name.strip()])


def _env(name: Argument, default: Argument | None = None) -> Substitution:
    return subs.EnvironmentVariable(name, default_value=default)


def _var(name: Argument, default: Argument | None = None) -> Substitution:
    return subs.LaunchConfiguration(name, default=default)


def _command(command: Argument, on_stderr: Argument | None = None) -> Substitution:
    return subs.Command(command) if on_stderr is None else subs.Command(command, on_stderr=on_stderr)


TABLE: dict[str, tuple[int, int, Callable[..., Any]]] = {
    "all": (0, 99, subs.AllSubstitution),
    "and": (2, 2, subs.AndSubstitution),
    "anon": (1, 1, subs.AnonName),
    "any": (0, 99, subs.AnySubstitution),
    "command": (1, 2, _command),
    "dirname": (0, 0, subs.ThisLaunchFileDir),
    "env": (1, 2, _env),
    "equals": (2, 2, subs.EqualsSubstitution),
    "eval": (1, 2, _python),
    "file-content": (1, 1, subs.FileContent),
    "filename": (0, 0, subs.ThisLaunchFile),
    "find-exec": (1, 1, lambda name: subs.FindExecutable(name=name)),
    "if": (2, 3, subs.IfElseSubstitution),
    "launch_log_dir": (0, 0, subs.LaunchLogDir),
    "log_dir": (0, 0, subs.LaunchLogDir),
    "not": (1, 1, subs.NotSubstitution),
    "not-equals": (2, 2, subs.NotEqualsSubstitution),
    "or": (2, 2, subs.OrSubstitution),
    "var": (1, 2, _var),
}
"""For each name the fewest and the most arguments, and what makes the substitution of them."""


def make(name: str, arguments: Sequence[Argument]) -> Substitution:
    """The substitution `$(name arguments...)`; RuntimeError, TypeError where there is none such."""
    if name not in TABLE:
        raise RuntimeError(f"Unknown substitution: {name}")
    fewest, most, substitution = TABLE[name]
    if not fewest <= len(arguments) <= most:
        expected = f"{fewest}" if fewest == most else f"{fewest} or {most}"
        what = "1 argument" if expected == "1" else f"{expected} arguments" if most else "no arguments"
        raise TypeError(f"{name} substitution expects {what}")
    made: Substitution = substitution(*arguments)
    return made
