"""A launch file in YAML."""

from __future__ import annotations

from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.some_substitutions_type import SomeSubstitutionsType


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch description of a file in YAML, read when it is included."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted YAML launch file")
