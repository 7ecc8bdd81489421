"""Processes of ours in Python: nothing of the learner's folder or environment is run in them."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping

FLAGS = ("-I", "-B", "-X", "utf8")
"""Without PYTHON* variables, the current folder and the user's own packages; no bytecode beside a learner's files."""


def module_command(module: str, *arguments: str) -> tuple[str, ...]:
    """The command that runs a module of ours."""
    return (sys.executable, *FLAGS, "-m", module, *arguments)


def add_python_path(environ: Mapping[str, str] = os.environ) -> None:
    """Find what PYTHONPATH names after all (a system's ROS is there), behind our own modules and Python's.

    Only absolute folders: an empty or relative one would be wherever we were started.
    """
    entries = environ.get("PYTHONPATH", "").split(os.pathsep)
    sys.path += [entry for entry in entries if os.path.isabs(entry) and entry not in sys.path]
