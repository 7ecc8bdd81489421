"""Parameters as written in launch files, in a normalized form, and evaluated for the node.

In the normalized form, a name is a tuple of substitutions, and nested dicts become dotted names. A value is a scalar or
a tuple: of scalars of one type, of substitutions (one text, parsed as YAML), or of lists of substitutions (one list per
array item).
"""

from __future__ import annotations

import atexit
import contextlib
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeSubstitutionsType, Substitution
from tutor.bundled_ros.launching.launch.text import parse_substitution
from tutor.bundled_ros.launching.launch.values import (
    TextSubstitution,
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    normalize_typed_substitution,
    perform_substitutions,
    perform_typed_substitution,
)


class ParameterValue:
    """A value of a given type (None: the type that YAML gives its text)."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self._value = normalize_typed_substitution(value, value_type)
        self._value_type = value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value. Raises ValueError if it cannot be converted to its type."""
        return perform_typed_substitution(context, self._value, self._value_type)


class Parameter:
    """A named value, passed to the node with `-p`."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._value = ParameterValue(value, value_type=value_type)

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return the name and the value."""
        return perform_substitutions(context, self._name), self._value.evaluate(context)


class ParameterFile:
    """A YAML parameter file. With `allow_substs`, launch substitutions in it, such as $(var x), are performed."""

    def __init__(
        self,
        param_file: str | os.PathLike[str] | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        ensure_argument_type(allow_substs, (bool, str, Substitution, Iterable), "allow_substs", "ParameterFile()")
        self._allow_substs = normalize_typed_substitution(allow_substs, bool)
        self._file = (
            os.fspath(param_file)
            if isinstance(param_file, os.PathLike)
            else normalize_to_list_of_substitutions(param_file)
        )

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the file's path, or that of a temporary copy with the substitutions performed."""
        path = Path(self._file if isinstance(self._file, str) else perform_substitutions(context, self._file))
        if not perform_typed_substitution(context, self._allow_substs, bool):
            return path
        text = perform_substitutions(context, parse_substitution(path.read_text(encoding="utf-8")))
        try:
            yaml.safe_load(text)
        except yaml.YAMLError as error:
            raise ValueError(f"the parameter file '{path}' is no YAML once its substitutions are performed") from error
        return temporary_file(text)


def temporary_file(text: str) -> Path:
    """Write a parameter file with this text, which is removed when the launch ends."""
    with tempfile.NamedTemporaryFile(mode="w", prefix="launch_params_", delete=False, dir=_temporary_folder()) as file:
        file.write(text)
    atexit.register(_remove, file.name)
    return Path(file.name)


def _temporary_folder() -> str | None:
    """Return the temporary folder of the `ros2` that runs us, which is removed however it ends; None without one."""
    overlay = os.environ.get("ROS_TUTOR_OVERLAY", "")
    return os.path.dirname(overlay) if os.path.isdir(overlay) else None


def _remove(path: str) -> None:
    with contextlib.suppress(OSError):
        os.unlink(path)


Name = tuple[Substitution, ...]


def normalize_parameters(parameters: Any) -> tuple[ParameterFile | Parameter | dict[Name, Any], ...]:
    """Normalize a list of dicts, parameter files and parameters. Raises TypeError for anything else."""
    if isinstance(parameters, str) or not isinstance(parameters, Sequence):
        raise TypeError(f"Expecting list of parameters, got {parameters}")
    return tuple(_normalize(item) for item in parameters)


def _normalize(item: Any) -> ParameterFile | Parameter | dict[Name, Any]:
    if isinstance(item, Mapping):
        return normalize_parameter_dict(item)
    if isinstance(item, Parameter | ParameterFile):
        return item
    return ParameterFile(item)


def normalize_parameter_dict(parameters: Mapping[Any, Any], *, _prefix: Sequence[Substitution] = ()) -> dict[Name, Any]:
    """Normalize a dict of parameters. Raises TypeError for a value that no parameter can have."""
    if not isinstance(parameters, Mapping):
        raise TypeError("expected dict")
    normalized: dict[Name, Any] = {}
    for given_name, value in parameters.items():
        name = (*_prefix, *normalize_to_list_of_substitutions(given_name))
        if isinstance(value, Mapping):
            normalized.update(normalize_parameter_dict(value, _prefix=(*name, TextSubstitution(text="."))))
        else:
            normalized[name] = _normalize_value(value)
    return normalized


def _normalize_value(value: Any) -> Any:
    if isinstance(value, ParameterValue | float | bool | int | bytes):
        return value
    if isinstance(value, str):
        # Dumped as YAML, it is parsed as a text again: "1" stays a text.
        return tuple(normalize_to_list_of_substitutions(yaml.dump(value)))
    if isinstance(value, Substitution):
        return (value,)
    if isinstance(value, Sequence):
        return _normalize_array(value)
    raise TypeError(f"Unexpected type for parameter value {value!r}")


def _normalize_array(value: Sequence[Any]) -> Any:
    for item in value:
        ensure_argument_type(item, (float, int, str, bool, Substitution, Sequence), "subvalue")
    kinds: set[type] = {
        type(item) if isinstance(item, str | bool | int | float) else Substitution
        for item in value
        if not _is_nested(item)
    }
    if any(_is_nested(item) for item in value):
        kinds.add(tuple)
    if kinds in ({int}, {bool}):
        return tuple(value)
    if kinds in ({float}, {int, float}):
        return tuple(float(item) for item in value)
    if Substitution in kinds and kinds <= {str, Substitution}:
        return tuple(normalize_to_list_of_substitutions(value))  # one text made of several parts
    items = [yaml.dump(item) if isinstance(item, float | int | bool | str) else item for item in value]
    return tuple(normalize_to_list_of_substitutions(item) for item in items)


def _is_nested(item: Any) -> bool:
    return isinstance(item, Sequence) and not isinstance(item, str)


SCALARS = (bool, int, float, str)
Evaluated = Path | Parameter | dict[str, Any]


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Evaluated, ...]:
    """Evaluate normalized parameters: files to paths, dicts to names and values. A Parameter stays as it is."""
    evaluated: list[Evaluated] = []
    for item in parameters:
        if isinstance(item, ParameterFile):
            evaluated.append(item.evaluate(context))
        elif isinstance(item, Parameter):
            evaluated.append(item)
        else:
            evaluated.append(evaluate_parameter_dict(context, item))
    return tuple(evaluated)


def evaluate_parameter_dict(context: LaunchContext, parameters: Mapping[Any, Any]) -> dict[str, Any]:
    """Evaluate a normalized dict; arrays become tuples. Raises TypeError for a value that no parameter can have."""
    evaluated: dict[str, Any] = {}
    for parts, value in parameters.items():
        name = perform_substitutions(context, parts)
        evaluated[name] = _evaluate(context, name, value)
    return evaluated


def _evaluate(context: LaunchContext, name: str, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if not isinstance(value, tuple):
        ensure_argument_type(value, (float, int, str, bool, bytes), "value")
        return value
    if value and isinstance(value[0], Substitution):
        return _parse_text(name, perform_substitutions(context, value))
    if value and isinstance(value[0], Sequence) and not isinstance(value[0], str):
        items = [yaml.safe_load(perform_substitutions(context, item)) for item in value]
        return _require_uniform(name, items)
    if not value:
        raise TypeError(f'Expected a non-empty sequence for "{name}"')
    return value


def _parse_text(name: str, text: str) -> Any:
    advice = (
        "If the parameter is meant to be a string, try wrapping it in "
        "launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
    )
    try:
        loaded = yaml.safe_load(text if text else "''")
    except yaml.YAMLError as error:
        raise TypeError(f"Unable to parse the value of parameter {name} as yaml. {advice}") from error
    if type(loaded) in (*SCALARS, bytes):
        return loaded
    if isinstance(loaded, Sequence):
        return _require_uniform(name, loaded)
    raise TypeError(
        "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], Sequence[float], "
        f'Sequence[str]. Got {type(loaded).__name__} for "{name}". {advice}'
    )


def _require_uniform(name: str, items: Sequence[Any]) -> tuple[Any, ...]:
    kinds = {type(item) for item in items}
    if len(kinds) != 1 or not kinds <= set(SCALARS):
        raise TypeError(
            "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, int, "
            f'float, str. Got inconsistent input for "{name}"'
        )
    return tuple(items)
