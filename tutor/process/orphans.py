"""Finds what is left of a run whose supervisor is gone: orphans adopted by us as subreaper, and marked processes."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterable
from dataclasses import dataclass

from tutor.process.process_table import Process, kill, processes

MARK = "ROS_TUTOR_RUN"

supervisors: set[int] = set()
"""Pids of our supervisors until they are reaped. They are children with their own session, as orphans are."""


@dataclass(frozen=True, slots=True)
class RunMarks:
    """The marks by which a run's processes are recognized.

    `run` is the value of `MARK` in their environment, `session` the learner's session id (None once it may have been
    reused), `pipes` the inodes of the pipes that they write to.
    """

    run: str
    session: int | None
    pipes: frozenset[int]


def find_orphans(marks: RunMarks) -> list[Process]:
    """Return live processes with one of the marks, orphans of any supervisor, and the descendants of both.

    Never includes this process or its ancestors. Reaps orphans that have ended.
    """
    table = processes()
    spared = set(_ancestors(os.getpid(), table))
    orphans = {p.pid for p in table.values() if _is_orphan(p)}
    for pid in orphans:
        with contextlib.suppress(ChildProcessError):
            os.waitpid(pid, os.WNOHANG)
    chosen = orphans | {p.pid for p in table.values() if p.pid not in spared and _has_mark(p, marks)}
    while more := {p.pid for p in table.values() if p.parent in chosen and p.pid not in spared} - chosen:
        chosen |= more
    return [table[pid] for pid in sorted(chosen) if table[pid].alive]


def end_orphans(limit_s: float = 1.0) -> None:
    """Kill orphans adopted from dead supervisors, and their descendants. Gives up after `limit_s` seconds."""
    until = time.monotonic() + limit_s
    while (found := find_orphans(RunMarks("", None, frozenset()))) and time.monotonic() < until:
        kill(found)
        time.sleep(0.002)


def command_line(pid: int) -> str:
    """Return the command line of a process, joined by spaces, or its short name if it has none; "" if it has ended."""
    for file in ("cmdline", "comm"):
        try:
            with open(f"/proc/{pid}/{file}", "rb") as opened:
                text = opened.read(4096).replace(b"\0", b" ").strip()
        except OSError:
            return ""
        if text:
            return text.decode("utf-8", "replace")
    return ""


def _is_orphan(process: Process) -> bool:
    """Whether we adopted it from a supervisor: our own children share our session, or are supervisors."""
    is_child = process.parent == os.getpid() and process.pid not in supervisors
    return is_child and process.session != os.getsid(0)


def _ancestors(pid: int, table: dict[int, Process]) -> Iterable[int]:
    while pid:
        yield pid
        pid = table[pid].parent if pid in table else 0


def _has_mark(process: Process, marks: RunMarks) -> bool:
    if process.session == marks.session:
        return True
    try:
        with open(f"/proc/{process.pid}/environ", "rb") as file:
            if f"{MARK}={marks.run}".encode() in file.read().split(b"\0"):
                return True
    except OSError:
        pass
    return _writes_to(process.pid, marks.pipes)


def _writes_to(pid: int, pipes: frozenset[int]) -> bool:
    folder = f"/proc/{pid}/fd"
    try:
        for name in os.listdir(folder):
            kind, _, inode = os.readlink(f"{folder}/{name}").partition(":[")
            # We hold the same pipes open too, but only for reading.
            if kind == "pipe" and int(inode[:-1]) in pipes and os.lstat(f"{folder}/{name}").st_mode & 0o200:
                return True
    except OSError:
        pass
    return False
