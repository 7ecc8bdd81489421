"""Launch files of any kind."""

from __future__ import annotations

import os.path

from .._unsupported import NotSupportedError
from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_description import LaunchDescription
from .frontend_launch_file_utilities import InvalidFrontendLaunchFileError, refuse_frontend_launch_file
from .python_launch_file_utilities import get_launch_description_from_python_launch_file


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """The launch description in a file; InvalidLaunchFileError where it cannot be read."""
    suffix = os.path.splitext(launch_file_path)[1].removeprefix(".")
    refuse_frontend_launch_file(launch_file_path, suffix)
    try:
        return get_launch_description_from_python_launch_file(launch_file_path)
    except NotSupportedError:
        raise
    except Exception as error:
        # The original goes on to try its other formats, and reports each.
        other = InvalidFrontendLaunchFileError("The launch file may have a syntax error, or its format is unknown")
        failure = InvalidLaunchFileError("py" if suffix == "py" else "", likely_errors=[error, other])
        raise failure from error
