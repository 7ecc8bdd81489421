"""`ros2 daemon start`."""

from __future__ import annotations

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--debug]."""
    parser.add_argument("--debug", "-d", action="store_true", help="the daemon's messages, of which there are none")


def main(_arguments: argparse.Namespace) -> None:
    """Say why nothing is started."""
    print("No daemon is needed: this ros2 finds the nodes by itself each time")
