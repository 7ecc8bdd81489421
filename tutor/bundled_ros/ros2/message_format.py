"""The options of verbs that print messages: what is truncated, what is left out and how lists are written."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any

from tutor.bundled_ros.ros2.parsing import argument, flag, unsigned_int
from tutor.ros.yaml_format import DEFAULT_MAX_LENGTH, to_csv, to_yaml

FORMAT = (
    flag("--full-length", "-f", help="long arrays and texts in full"),
    argument(
        "--truncate-length",
        "-l",
        type=unsigned_int,
        default=DEFAULT_MAX_LENGTH,
        help=f"after how many elements arrays and texts are cut (default: {DEFAULT_MAX_LENGTH})",
    ),
    flag("--no-arr", help="only type and length of arrays"),
    flag("--no-str", help="only the length of texts"),
    flag("--flow-style", help="lists in one line"),
)


@dataclass(frozen=True, slots=True)
class MessageFormat:
    """How messages are printed. `max_length` is the length at which arrays and texts are truncated (None: never)."""

    max_length: int | None
    no_arrays: bool
    no_strings: bool
    flow_style: bool

    @classmethod
    def of(cls, arguments: argparse.Namespace) -> MessageFormat:
        """Build the format from the parsed options."""
        max_length = None if arguments.full_length else arguments.truncate_length
        return cls(max_length, arguments.no_arr, arguments.no_str, arguments.flow_style)

    def yaml(self, message: Any) -> str:
        """Format the message as YAML."""
        return to_yaml(
            message,
            max_length=self.max_length,
            no_arrays=self.no_arrays,
            no_strings=self.no_strings,
            flow_style=self.flow_style,
        )

    def csv(self, message: Any) -> str:
        """Format the message's values, separated by commas."""
        return to_csv(message, max_length=self.max_length, no_arrays=self.no_arrays, no_strings=self.no_strings)
