"""A condition on one launch configuration; deprecated, but still met in tutorials."""

from __future__ import annotations

from ..launch_context import LaunchContext
from .launch_configuration_equals import LaunchConfigurationEquals


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """True where the launch configuration has another value."""

    def _is_met(self, context: LaunchContext) -> bool:
        return not super()._is_met(context)
