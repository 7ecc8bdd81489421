"""Parameters as they are written, in the few forms in which they are evaluated, and as the node gets them.

In those forms a name is a tuple of substitutions; nested dicts are names with dots. A value stays what it is, or is a
tuple: of values of one type, of substitutions (one text, read as YAML), or of lists of substitutions (one for each
item).
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
from launch._entities import SomeSubstitutionsType, Substitution, TextSubstitution
from launch._frontend.text import parse_substitution
from launch.launch_context import LaunchContext
from launch.utilities import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    normalize_typed_substitution,
    perform_substitutions,
    perform_typed_substitution,
)


class ParameterValue:
    """A value of a given type; without a type, of the type that its text has as YAML."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self._value = normalize_typed_substitution(value, value_type)
        self._value_type = value_type

    @property
    def value(self) -> Any:
        return self._value

    @property
    def value_type(self) -> Any:
        return self._value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """The value; ValueError where it is none of that type."""
        return perform_typed_substitution(context, self._value, self._value_type)


class Parameter:
    """A name with a value, given to the node with `-p`."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._value = ParameterValue(value, value_type=value_type)

    @property
    def name(self) -> list[Substitution]:
        return self._name

    @property
    def value(self) -> Any:
        return self._value.value

    @property
    def value_type(self) -> Any:
        return self._value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """The name and the value."""
        return perform_substitutions(context, self._name), self._value.evaluate(context)


class ParameterFile:
    """A YAML file of parameters; with `allow_substs` those of launch, such as $(var x), are performed in it."""

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

    @property
    def allow_substs(self) -> Any:
        return self._allow_substs

    @property
    def param_file(self) -> Any:
        return self._file

    def evaluate(self, context: LaunchContext) -> Path:
        """The file's path, or that of a copy with the substitutions performed, which goes when the launch ends."""
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
    """A file of parameters with this text, which is there as long as the launch runs."""
    with tempfile.NamedTemporaryFile(mode="w", prefix="launch_params_", delete=False, dir=_folder()) as file:
        file.write(text)
    atexit.register(_remove, file.name)
    return Path(file.name)


def _folder() -> str | None:
    """That of the `ros2` around us, which goes with it however it ends."""
    overlay = os.environ.get("ROS_TUTOR_OVERLAY", "")
    return os.path.dirname(overlay) if os.path.isdir(overlay) else None


def _remove(path: str) -> None:
    with contextlib.suppress(OSError):
        os.unlink(path)


Name = tuple[Substitution, ...]


def normalize_parameters(parameters: Any) -> tuple[ParameterFile | Parameter | dict[Name, Any], ...]:
    """Dicts, files and parameters; TypeError for anything else than a list of them."""
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
    """One dict of parameters; TypeError where a value is none that a parameter can have."""
    if not isinstance(parameters, Mapping):
        raise TypeError("expected dict")
    normalized: dict[Name, Any] = {}
    for given_name, value in parameters.items():
        name = (*_prefix, *normalize_to_list_of_substitutions(given_name))
        if isinstance(value, Mapping):
            normalized.update(normalize_parameter_dict(value, _prefix=(*name, TextSubstitution(text="."))))
        else:
            normalized[name] = _value(value)
    return normalized


def _value(value: Any) -> Any:
    if isinstance(value, ParameterValue | float | bool | int | bytes):
        return value
    if isinstance(value, str):
        # As YAML it comes back as the text that it is: "1" stays a text.
        return tuple(normalize_to_list_of_substitutions(yaml.dump(value)))
    if isinstance(value, Substitution):
        return (value,)
    if isinstance(value, Sequence):
        return _array(value)
    raise TypeError(f"Unexpected type for parameter value {value!r}")


def _array(value: Sequence[Any]) -> Any:
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
        return tuple(normalize_to_list_of_substitutions(value))  # one text in several parts
    items = [yaml.dump(item) if isinstance(item, float | int | bool | str) else item for item in value]
    return tuple(normalize_to_list_of_substitutions(item) for item in items)


def _is_nested(item: Any) -> bool:
    return isinstance(item, Sequence) and not isinstance(item, str)


SCALARS = (bool, int, float, str)
Evaluated = Path | Parameter | dict[str, Any]


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Evaluated, ...]:
    """What normalize_parameters gave: files as paths, dicts with names and values; a Parameter stays what it is."""
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
    """Names and values; TypeError where a value is none that a parameter can have. Arrays become tuples."""
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
        return _from_text(name, perform_substitutions(context, value))
    if value and isinstance(value[0], Sequence) and not isinstance(value[0], str):
        items = [yaml.safe_load(perform_substitutions(context, item)) for item in value]
        return _uniform(name, items)
    if not value:
        raise TypeError(f'Expected a non-empty sequence for "{name}"')
    return value


def _from_text(name: str, text: str) -> Any:
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
        return _uniform(name, loaded)
    raise TypeError(
        "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], Sequence[float], "
        f'Sequence[str]. Got {type(loaded).__name__} for "{name}". {advice}'
    )


def _uniform(name: str, items: Sequence[Any]) -> tuple[Any, ...]:
    kinds = {type(item) for item in items}
    if len(kinds) != 1 or not kinds <= set(SCALARS):
        raise TypeError(
            "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, int, "
            f'float, str. Got inconsistent input for "{name}"'
        )
    return tuple(items)
