"""`ros-tutor doctor`: which ROS is used, and what is wrong with the machine."""

from __future__ import annotations

import argparse
import sys

from tutor.cli import context, terminal
from tutor.cli.errors import FAULT, PASSED

_MARKS = {True: ("✓", "ok", "32"), None: ("!", "warning", "33"), False: ("✗", "wrong", "31")}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add nothing: `doctor` takes no arguments."""


def run(arguments: argparse.Namespace) -> int:
    """Print one line per finding, followed by its hint; return exit code 3 if something is wrong."""
    from tutor.doctor import examine

    findings = examine(context.choose_any_workspace(arguments).root)
    width = max((len(finding.name) for finding in findings), default=0)
    for finding in findings:
        mark, word, color = _MARKS[finding.ok]
        state = terminal.style(f"{mark} {word:7}", color, sys.stdout)
        terminal.out(f"{state}  {finding.name:{width}}  {finding.text}\n")
        if finding.hint and finding.ok is not True:
            terminal.out(f"{'':9}  {'':{width}}  fix: {finding.hint}\n")
    return FAULT if any(finding.ok is False for finding in findings) else PASSED
