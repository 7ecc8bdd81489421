"""Tab completion of `ros2` with argcomplete: verbs and options from the parser, names and types from the live graph."""

from __future__ import annotations

import os
from collections.abc import Callable

from tutor.bundled_ros.ros2.parsing import LazyParser

_COMPLETE_VARIABLE = "_ARGCOMPLETE"
"""The variable that a shell sets when it wants completions rather than the command itself."""


def is_requested() -> bool:
    """Return whether the shell wants completions."""
    return _COMPLETE_VARIABLE in os.environ


def print_completions(parser: LazyParser) -> None:
    """Print the completions for the shell and end the process."""
    import argcomplete
    from argcomplete.lexers import split_line

    # argcomplete patches the arguments a parser already has and misses any that are added later.
    parser.fill_for(split_line(os.environ["COMP_LINE"], int(os.environ["COMP_POINT"]))[3][1:])
    argcomplete.autocomplete(parser, exclude=["-h", "--help"])


def types_of_kind(kind: str = "") -> Callable[..., list[str]]:
    """Return a completer of all types, or of those of one kind (msg, srv or action)."""

    def complete(**_: object) -> list[str]:
        from tutor.ros.interfaces import type_names  # late: every command imports this module

        return type_names(kind)

    return complete


def registration_code(shell: str) -> str:
    """Return the bash or zsh code that registers completion for `ros2`."""
    from argcomplete.shell_integration import shellcode

    return shellcode(["ros2"], shell=shell)
