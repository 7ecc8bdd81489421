"""A launch description is to be run."""

from __future__ import annotations

from ..event import Event
from ..launch_description import LaunchDescription


class IncludeLaunchDescription(Event):
    """Asks for the visit of a launch description."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: LaunchDescription) -> None:
        self._description = launch_description

    @property
    def launch_description(self) -> LaunchDescription:
        return self._description
