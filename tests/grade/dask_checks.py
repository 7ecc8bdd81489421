"""What the workers of a test cluster do instead of a check."""

from __future__ import annotations

import os
import signal

from tutor.grade.dask_worker import Versions
from tutor.grade.unit import Outcome, Unit


async def kill_the_worker(unit: Unit, key: str, expected: Versions) -> Outcome:
    """Do what a submission can that is not isolated."""
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError("killed")


async def fail(unit: Unit, key: str, expected: Versions) -> Outcome:
    """Fail as code of ours would that has a bug."""
    raise ZeroDivisionError("in\x1b[31m\n code of ours")


async def tell_process_group(unit: Unit, key: str, expected: Versions) -> Outcome:
    """Return the process group of the worker, and whether Ctrl+C can end a child of it."""
    blocked = signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ())
    return Outcome(None, fault=f"{os.getpgid(0)} {blocked}")
