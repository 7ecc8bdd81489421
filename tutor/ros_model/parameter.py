"""A node's parameter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

PARAMETER_TYPES = (
    "not set",
    "boolean",
    "integer",
    "double",
    "string",
    "byte array",
    "boolean array",
    "integer array",
    "double array",
    "string array",
)
"""The types of `rcl_interfaces/msg/ParameterType`, by number, as `ros2 param describe` names them."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One parameter of a node. `type` is one of `PARAMETER_TYPES`."""

    node: str
    name: str
    type: str
    value: Any
    read_only: bool = False
    minimum: float | None = None
    maximum: float | None = None
