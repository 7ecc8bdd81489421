"""Finds out whether submissions can be isolated on this machine."""

from __future__ import annotations

import subprocess

from tutor import interpreter
from tutor.errors import EngineError
from tutor.invocation import command

_LIMIT_S = 30.0


def why_not_isolated() -> EngineError | None:
    """Return why submissions cannot be isolated here, with what to do; None if they can. Tries it in a process."""
    argv = interpreter.module_command("tutor.engine", "--try-isolation")
    try:
        tried = subprocess.run(argv, capture_output=True, text=True, errors="replace", timeout=_LIMIT_S, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return EngineError(f"it cannot be tried ({error})", f"see `{command('doctor')}`")
    if tried.returncode == 0:
        return None
    what, _, hint = (tried.stderr.strip().splitlines() or ["unknown. "])[-1].partition(". ")
    return EngineError(what.removeprefix("--isolate: "), hint)
