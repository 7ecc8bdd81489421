"""Starts and sets up our own Python processes, in which no code from the learner's folder or environment runs."""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Mapping, Sequence
from typing import NoReturn

from tutor import run_module

FLAGS = ("-I", "-B", "-X", "utf8")
"""Ignore PYTHON* variables, the current folder and user packages; write no bytecode next to a learner's files."""

BLOCK_SIGINT_PREFIX = "$(env --block-signal=INT true 2>/dev/null && echo env --block-signal=INT)"
"""Shell prefix for a program that calls `unblock_sigint`: it blocks Ctrl+C while Python starts, where it would print
a traceback."""


def module_command(module: str, *arguments: str) -> tuple[str, ...]:
    """Return the command that runs one of our modules."""
    return (sys.executable, *FLAGS, run_module.__file__, module, *arguments)


def reduce_gc_frequency() -> None:
    """Run the cyclic garbage collector less often: by default, it takes a fifth of the app's CPU time.

    Call this before most imports.
    """
    gc.set_threshold(50_000, 20, 50)


def add_python_path(environ: Mapping[str, str] = os.environ) -> None:
    """Append the folders in PYTHONPATH to sys.path despite `-I`: a system ROS is found through them.

    Only absolute ones: an empty or relative folder would depend on where we were started.
    """
    entries = environ.get("PYTHONPATH", "").split(os.pathsep)
    sys.path += [entry for entry in entries if os.path.isabs(entry) and entry not in sys.path]


def unblock_sigint() -> None:
    """Unblock SIGINT, which the starter of this process may have blocked, as `exec_program` does."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


def exec_program(command: Sequence[str], env: Mapping[str, str]) -> NoReturn:
    """Replace this process with another of our programs, which must call `unblock_sigint`. Raises OSError."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        os.execve(command[0], list(command), env)
    finally:
        unblock_sigint()
