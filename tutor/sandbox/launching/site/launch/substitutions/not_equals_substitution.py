"""Whether two texts mean different things."""

from __future__ import annotations

from ..launch_context import LaunchContext
from .equals_substitution import EqualsSubstitution


class NotEqualsSubstitution(EqualsSubstitution):
    """`true` where the two do not mean the same."""

    def perform(self, context: LaunchContext) -> str:
        return str(not self._equal(context)).lower()
