"""Our own Python processes: nothing of the learner's folder or environment is run in them."""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Mapping, Sequence
from typing import NoReturn

FLAGS = ("-I", "-B", "-X", "utf8")
"""Without PYTHON* variables, the current folder and the user's own packages; no bytecode beside a learner's files."""

CTRL_C_LATER = "$(env --block-signal=INT true 2>/dev/null && echo env --block-signal=INT)"
"""In sh, before the command of a program that `answers_ctrl_c`: while Python starts, Ctrl+C would be a traceback."""


def module_command(module: str, *arguments: str) -> tuple[str, ...]:
    """The command that runs one of our modules."""
    return (sys.executable, *FLAGS, "-m", module, *arguments)


def collect_garbage_seldom() -> None:
    """Look for garbage in cycles less often: by default, that takes a fifth of the app's CPU time.

    To be called before most is imported.
    """
    gc.set_threshold(50_000, 20, 50)


def add_python_path(environ: Mapping[str, str] = os.environ) -> None:
    """Find what PYTHONPATH names after all (a system's ROS is there), behind our own modules and Python's.

    Only absolute folders: an empty or relative one would be wherever we were started.
    """
    entries = environ.get("PYTHONPATH", "").split(os.pathsep)
    sys.path += [entry for entry in entries if os.path.isabs(entry) and entry not in sys.path]


def answer_ctrl_c() -> None:
    """Let Ctrl+C through: whatever started this process may have kept it waiting, as `become` does."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


def become(command: Sequence[str], env: Mapping[str, str]) -> NoReturn:
    """Run another of our programs, which calls `answer_ctrl_c`, in place of this one. Raises OSError."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        os.execve(command[0], list(command), env)
    finally:
        answer_ctrl_c()
