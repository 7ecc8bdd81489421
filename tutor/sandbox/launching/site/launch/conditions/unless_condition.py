"""True where a text says false."""

from __future__ import annotations

from ..launch_context import LaunchContext
from .if_condition import IfCondition


class UnlessCondition(IfCondition):
    """Lets an action happen where the expression is false."""

    def _is_met(self, context: LaunchContext) -> bool:
        return not super()._is_met(context)
