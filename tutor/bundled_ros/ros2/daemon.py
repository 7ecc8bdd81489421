"""`ros2 daemon`: a stub, since no daemon is needed. It keeps scripts working that start, stop or query the daemon."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.parsing import Group, Verb, Verbs


def _start(_: argparse.Namespace) -> None:
    print("No daemon is needed: this ros2 finds the nodes by itself each time")


def _say_that_there_is_none(_: argparse.Namespace) -> None:
    print("The daemon is not running")


_VERBS: Verbs = {
    "start": ("Do nothing: no daemon is needed", Verb(_start)),
    "status": ("Say that the daemon is not running", Verb(_say_that_there_is_none)),
    "stop": ("Do nothing: no daemon is running", Verb(_say_that_there_is_none)),
}
GRAMMAR = {"daemon": Group(_VERBS)}
