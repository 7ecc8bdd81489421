"""Parameters as they are written, in the few forms in which they are evaluated.

A name becomes a tuple of substitutions; nested dicts become names with dots. A value stays what it is, or becomes a
tuple: of values of one type, of substitutions (one text, read as YAML), or of lists of substitutions (one for each
item).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import yaml
from launch.substitution import Substitution
from launch.substitutions.text_substitution import TextSubstitution
from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

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
