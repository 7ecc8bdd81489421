"""The folder of the launch file."""

from __future__ import annotations

from ..launch_context import LaunchContext
from .path_join_substitution import FoundPath
from .substitution_failure import SubstitutionFailure


class ThisLaunchFileDir(FoundPath):
    """The folder of the launch file that was included last."""

    def describe(self) -> str:
        return "ThisLaunchFileDir()"

    def perform(self, context: LaunchContext) -> str:
        folder: str | None = context.get_locals_as_dict().get("current_launch_file_directory")
        if folder is None:
            raise SubstitutionFailure("ThisLaunchFileDir used outside of a launch file (in a script)")
        return folder
