"""Parameters as the node gets them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from launch.launch_context import LaunchContext
from launch.substitution import Substitution
from launch.utilities import ensure_argument_type, perform_substitutions

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

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
