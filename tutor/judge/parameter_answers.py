"""Answers to parameter requests: which reasons are rclpy's own, and not the learner's."""

from __future__ import annotations

import re

_RCLPY_REASON = re.compile(
    r"Callback returned an invalid type"
    r"|Wrong parameter type, expected '.*' got '"
    r"|Trying to set a read-only parameter: "
    r"|Static parameter cannot be undeclared"
    r"|parameter list cannot be empty, this might be due to pre_set_parameters_callback"
    r"|Invalid access to undeclared parameter\(s\): "
)
"""Nearly whole sentences, since a learner's reason may well read "it cannot be set to 0".

A value outside a declared range is not among them: the learner declared that range.
"""


def is_from_rclpy(reason: str) -> bool:
    """Whether rclpy itself rejected a value, in contrast to the learner's code."""
    return _RCLPY_REASON.match(reason) is not None
