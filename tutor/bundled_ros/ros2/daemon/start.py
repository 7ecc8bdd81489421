"""`ros2 daemon start`."""

from __future__ import annotations

import argparse


def main(_arguments: argparse.Namespace) -> None:
    """Explain why nothing is started."""
    print("No daemon is needed: this ros2 finds the nodes by itself each time")
