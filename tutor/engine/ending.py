"""How the learner's process is ended: interrupted while it is blocked, or aborted so that it dumps its stacks."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time
from collections.abc import Callable

from tutor.engine.source import add_source_lines
from tutor.judge import tracebacks
from tutor.judge.trace import Ending
from tutor.judge.tracebacks import Frame
from tutor.process import LearnerProcess, NextWake, fork_link
from tutor.process.cpu_wait import MAX_EXTENSION_FACTOR

BLOCKED_S = 0.5
"""Maximum delay of Ctrl+C until the node has finished what it is doing; one that is always busy never has."""

BLOCKED_POLL_S = 0.01

BLOCKED_POLLS = 3
"""How many polls in a row must find all threads blocked, with none having run in between.

A process that is ending blocks too, but only for a moment at a time.
"""

CHILD_EXIT_S = 1.0
"""Grace period for child processes that are about to exit after the first process has."""

CHILD_POLL_S = 0.05

DUMP_S = 2.0
"""How long an aborted process may take to write its stacks and end."""


async def wait_until_blocked(process: LearnerProcess, cpu_wait_s: Callable[[], float]) -> None:
    """Wait until all threads of the process are blocked, as they usually are when someone presses Ctrl+C.

    A node that is still handling our last request may end in another way than one that waits, and one that our last
    request has ended is not ended by Ctrl+C. `cpu_wait_s`: for how long it has waited for a CPU so far.
    """
    began, waited_before_s, last, polls = time.monotonic(), cpu_wait_s(), NextWake(), 0

    def limit_s() -> float:
        return BLOCKED_S + min(cpu_wait_s() - waited_before_s, MAX_EXTENSION_FACTOR * BLOCKED_S)

    while process.exit is None and time.monotonic() - began < limit_s():
        wake = process.next_wake()
        polls = 0 if wake.at == 0.0 else polls + 1 if wake.timeslices == last.timeslices else 1
        if polls >= BLOCKED_POLLS:
            return
        last = wake
        await asyncio.sleep(BLOCKED_POLL_S)


async def ending_of(
    process: LearnerProcess, interrupted_at: float, limit_s: float, cpu_wait_share: float
) -> Ending | None:
    """Return how a process ended, or did not within `limit_s`, after Ctrl+C; None if that did not reach it.

    `interrupted_at`: in seconds since the epoch. `cpu_wait_share`: the share of the time before, in which it waited for
    a CPU.
    """
    ended = process.exit
    if ended is not None and not process.interrupted:
        return None
    took_s = (process.started_at + ended.after_s if ended is not None else time.time()) - interrupted_at
    survivors = await _survivors(process)
    output = tuple(line for line in process.output if line.at >= interrupted_at)
    return Ending(ended, took_s, limit_s, output, survivors, cpu_wait_share)


async def _survivors(process: LearnerProcess) -> tuple[str, ...]:
    """The command lines of surviving processes, after a grace period if the first process has ended."""
    deadline = time.monotonic() + (CHILD_EXIT_S if process.exit is not None else 0.0)
    while (left := process.survivors()) and time.monotonic() < deadline:
        await asyncio.sleep(CHILD_POLL_S)
    return tuple(survivor.command for survivor in left)


async def dump_stacks(process: LearnerProcess) -> tuple[Frame, ...]:
    """Abort the process, and return the frames of all its threads, innermost first; () if it has ended already."""
    if process.exit is not None:
        return ()
    aborted_at = time.time()
    # PYTHONFAULTHANDLER (set by the bench) makes a fatal signal write all threads' stacks to stderr.
    with contextlib.suppress(ProcessLookupError):
        os.kill(process.pid, signal.SIGABRT)
    await process.wait(DUMP_S)
    frames = tracebacks.dumped_frames(line for line in process.output if line.at >= aborted_at)
    return add_source_lines([frame for frame in frames if frame.path != str(fork_link.PROGRAM)])
