"""What a user of the `ros2` command can get wrong."""

from __future__ import annotations


class CommandError(Exception):
    """The command cannot be done; the text is one line that says why."""
