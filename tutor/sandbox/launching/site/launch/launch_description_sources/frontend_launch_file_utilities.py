"""Launch files that are not Python."""

from __future__ import annotations

from .._frontend import load_launch_description
from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_description import LaunchDescription


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A file in no format of launch files."""


def get_launch_description_from_frontend_launch_file(frontend_launch_file_path: str) -> LaunchDescription:
    """The launch description in an XML or YAML file; raises what is wrong with it."""
    return load_launch_description(frontend_launch_file_path)
