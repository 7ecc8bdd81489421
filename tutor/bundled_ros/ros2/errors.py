"""What a user of the `ros2` command can get wrong."""

from __future__ import annotations


class CommandError(Exception):
    """The command cannot be done; the text says why, and goes to stderr as it stands. `code` is the exit code."""

    def __init__(self, text: str, code: int = 1) -> None:
        super().__init__(text)
        self.code = code


def yaml_problem(error: Exception) -> str:
    """What a yaml.YAMLError says, in one line and without the place."""
    return " ".join(str(getattr(error, "problem", None) or error).split())
