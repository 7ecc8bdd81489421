"""Parameters of nodes."""

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
"""Names of the types, as shown by `ros2 param describe`, indexed by `rcl_interfaces/msg/ParameterType`."""


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
