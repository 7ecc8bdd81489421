"""`ros2 service`."""

from __future__ import annotations

import argparse

VERBS = {
    "call": "Call a service and show its answer",
    "echo": "Show the calls of a service, where it publishes them",
    "find": "List the services of a type",
    "info": "Show a service's type, and how many offer and call it",
    "list": "List the services",
    "type": "Show a service's type",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """[--include-hidden-services]."""
    parser.add_argument("--include-hidden-services", action="store_true", help="hidden services as well")
