"""Tab completion of `ros2`, by argcomplete: verbs and options by the parser, names and types by what is there now."""

from __future__ import annotations

import os

from tutor.bundled_ros.ros2.parsing import LazyParser

ASKED = "_ARGCOMPLETE"
"""The variable by which a shell asks for completions, in place of running the command."""


def is_asked() -> bool:
    """Whether the shell wants completions."""
    return ASKED in os.environ


def answer(parser: LazyParser) -> None:
    """Give the shell its completions, and end the process."""
    import argcomplete
    from argcomplete.lexers import split_line

    # argcomplete patches the arguments that a parser has, and misses those that it would get later.
    parser.fill_along(split_line(os.environ["COMP_LINE"], int(os.environ["COMP_POINT"]))[3][1:])
    argcomplete.autocomplete(parser, exclude=["-h", "--help"])


def registration(shell: str) -> str:
    """The lines of bash or zsh that make Tab ask `ros2`."""
    from argcomplete.shell_integration import shellcode

    return shellcode(["ros2"], shell=shell)
