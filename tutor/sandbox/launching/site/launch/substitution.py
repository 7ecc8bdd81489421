"""The base of all substitutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Substitution:
    """A text that is known only while the launch file runs."""

    def describe(self) -> str:
        return repr(self)

    def perform(self, context: LaunchContext) -> str:
        """The text, in this context."""
        raise NotImplementedError(f"{type(self).__name__} has no perform()")
