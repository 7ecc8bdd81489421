"""A launch file in XML or YAML, read when it is included."""

from __future__ import annotations

from ..launch_description import LaunchDescription
from ..launch_description_source import LaunchDescriptionSource
from ..some_substitutions_type import SomeSubstitutionsType
from .frontend_launch_file_utilities import get_launch_description_from_frontend_launch_file


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description of a file in XML or YAML."""

    def __init__(
        self, launch_file_path: SomeSubstitutionsType, *, method: str = "interpreted frontend launch file"
    ) -> None:
        super().__init__(None, launch_file_path, method)

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return get_launch_description_from_frontend_launch_file(location)
