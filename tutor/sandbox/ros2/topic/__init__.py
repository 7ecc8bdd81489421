"""`ros2 topic`."""

from __future__ import annotations

import argparse

VERBS = {
    "find": "List the topics of a type",
    "info": "Show a topic's type, and how many publish and subscribe to it",
    "list": "List the topics",
    "type": "Show a topic's type",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--include-hidden-topics]."""
    parser.add_argument("--include-hidden-topics", action="store_true", help="hidden topics as well")
