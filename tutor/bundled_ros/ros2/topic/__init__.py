"""`ros2 topic`."""

from __future__ import annotations

import argparse

VERBS = {
    "bw": "Measure how many bytes a second a topic carries",
    "delay": "Measure how old a topic's messages are when they arrive, by their header",
    "echo": "Print the messages on a topic",
    "find": "List the topics of a type",
    "hz": "Measure a topic's rate",
    "info": "Show a topic's type, and how many publish and subscribe to it",
    "list": "List the topics",
    "pub": "Publish messages on a topic",
    "type": "Show a topic's type",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--include-hidden-topics]."""
    parser.add_argument("--include-hidden-topics", action="store_true", help="hidden topics as well")
