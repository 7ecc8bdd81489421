"""The folder of this launch's log files."""

from __future__ import annotations

from ..launch_context import LaunchContext
from ..logging import launch_config
from .path_join_substitution import FoundPath


class LaunchLogDir(FoundPath):
    """The folder in which this launch and what it starts log."""

    def describe(self) -> str:
        return "LaunchLogDir()"

    def perform(self, context: LaunchContext) -> str:
        return launch_config.log_dir
