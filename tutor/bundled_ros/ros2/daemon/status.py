"""`ros2 daemon status`."""

from __future__ import annotations

import argparse


def main(_arguments: argparse.Namespace) -> None:
    """Say that the daemon is not running."""
    print("The daemon is not running")
