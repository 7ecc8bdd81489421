"""A launch file in XML."""

from __future__ import annotations

from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.some_substitutions_type import SomeSubstitutionsType


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch description of a file in XML, read when it is included."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted XML launch file")
