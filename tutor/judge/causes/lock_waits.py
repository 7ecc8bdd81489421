"""A callback that waits for a lock which nothing is going to release."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from tutor.judge import source, tracebacks
from tutor.judge.causes import names
from tutor.judge.edits import Edit
from tutor.judge.rewriting.callbacks import make_lock_reentrant, remove_lock
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.rewriting.program import first_sound_step
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause

LOCK_LINE = re.compile(
    r"(?P<lock>[\w.]+)\.acquire\(|with (?P<with>[\w.]*(?:lock|mutex|semaphore|condition)\w*)", re.IGNORECASE
)


def diagnose_lock(trace: Trace, stuck: Sequence[Frame], at: Frame) -> Cause:
    """Diagnose the callback that waits for a lock `at` a line: who holds the lock, or that nobody else can."""
    found = LOCK_LINE.search(at.code)
    lock = (found["lock"] or found["with"]) if found else "the lock"
    made = next((call for call in source.calls(trace, "Lock") if call.lineno), None)
    holders = [
        frame
        for thread in tracebacks.frames_by_thread(stuck)
        if (frame := tracebacks.own_frame(thread, trace.folder)) is not None
        and tracebacks.called_by_executor(thread, trace.folder)
        and not LOCK_LINE.search(frame.code)
    ]
    if holders:
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"a callback waits for {lock}, at {at}, which another one holds at {holders[0]}",
            step_at(trace, holders[0], lambda file: remove_lock(file, holders[0].line))
            or f"take line {holders[0].line} out of the lock: what takes long goes above `with {lock}:`, or below it, "
            "with less indentation",
        )
    where = f" in line {made.lineno}" if made else ""
    return Cause(
        names.BLOCKED_EXECUTOR,
        f"a callback waits for {lock}, at {at}, forever: it is already held, by the same callback or by one that did "
        "not release it",
        step_at(trace, at, make_lock_reentrant)
        or f"write threading.RLock() in place of threading.Lock(){where}: one thread may take it twice; and with "
        f"{lock}: in place of acquire() and release()",
    )


def step_at(trace: Trace, at: Frame, edits: Callable[[NodeFile], Sequence[Edit]]) -> str | None:
    """The step that edits the file of a frame; None unless that file still contains the frame's line."""
    text = trace.sources.get(at.name, "").splitlines()
    is_current = 0 < at.line <= len(text) and text[at.line - 1].strip() == at.code
    return first_sound_step(trace, edits, name=at.name) if is_current else None
