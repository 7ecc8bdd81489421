"""The arguments that several verbs of `ros2` share."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.domain import LIMIT_S
from tutor.bundled_ros.ros2.parsing import Argument, Completer, OneOf, argument, flag

DIRECT = (
    argument(
        "--spin-time",
        type=float,
        help=f"the longest wait for others to be found, in seconds (default: {LIMIT_S:g}; it usually takes far less)",
    ),
    flag("-s", "--use-sim-time", help="use the time of a simulation (/clock)"),
)
"""The options of every verb that joins the domain."""

STRATEGY = (*DIRECT, flag("--no-daemon", help="always so here: there is no daemon"))
"""The options of every verb for which ros2cli would ask its daemon."""

SHOW_TYPES = flag("-t", "--show-types", help="the types as well")
CSV = flag("--csv", help="all values, separated by commas")


def count(things: str) -> Argument:
    """Return the option that only counts what would be listed."""
    return flag("-c", f"--count-{things}", dest="count", help=f"only how many {things} there are")


def hidden(things: str, *, of_verb: bool = True) -> Argument:
    """Return the option that includes what is hidden. A verb leaves the value of its command's own option alone."""
    default = argparse.SUPPRESS if of_verb else False
    return flag(f"--include-hidden-{things}", dest="hidden", default=default, help=f"hidden {things} as well")


def yaml_or_stdin(name: str, help: str, *, stdin_help: str, complete: Completer | None = None) -> OneOf:
    """Return the argument for a message as YAML, or --stdin in its place."""
    return OneOf(
        argument(name, nargs="?", default="{}", complete=complete, help=help), flag("--stdin", help=stdin_help)
    )
