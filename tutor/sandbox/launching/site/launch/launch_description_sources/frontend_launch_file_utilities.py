"""Launch files that are not Python."""

from __future__ import annotations

from .._unsupported import refuse

FORMATS = {"xml": "XML", "yaml": "YAML", "yml": "YAML"}
"""The suffixes of launch files that only an installed ROS 2 reads."""


class InvalidFrontendLaunchFileError(Exception):
    """A file in no format of launch files."""


def refuse_frontend_launch_file(path: str, suffix: str) -> None:
    """Raise NotSupportedError where the suffix (no dot) is that of an XML or YAML launch file."""
    if suffix in FORMATS:
        refuse(f"the {FORMATS[suffix]} launch file '{path}'")
