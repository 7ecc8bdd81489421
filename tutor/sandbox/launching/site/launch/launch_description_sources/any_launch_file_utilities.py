"""Launch files of any kind."""

from __future__ import annotations

import os.path

from .._frontend import suffixes
from .._unsupported import NotSupportedError
from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_description import LaunchDescription
from .frontend_launch_file_utilities import (
    InvalidFrontendLaunchFileError,
    get_launch_description_from_frontend_launch_file,
)
from .python_launch_file_utilities import get_launch_description_from_python_launch_file


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """The launch description in a file; InvalidLaunchFileError where it cannot be read."""
    suffix = os.path.splitext(launch_file_path)[1].removeprefix(".")
    if suffix == "py":
        return _from_python(launch_file_path)
    try:
        return get_launch_description_from_frontend_launch_file(launch_file_path)
    except NotSupportedError:
        raise
    except Exception as error:
        if suffixes(launch_file_path):
            raise InvalidLaunchFileError(suffix, likely_errors=[error]) from error
    try:
        return get_launch_description_from_python_launch_file(launch_file_path)
    except NotSupportedError:
        raise
    except Exception as error:
        raise InvalidLaunchFileError(likely_errors=[error]) from error


def _from_python(path: str) -> LaunchDescription:
    try:
        return get_launch_description_from_python_launch_file(path)
    except NotSupportedError:
        raise
    except Exception as error:
        # The original goes on to try its other formats, and reports each.
        other = InvalidFrontendLaunchFileError()
        raise InvalidLaunchFileError("py", likely_errors=[error, other]) from error
