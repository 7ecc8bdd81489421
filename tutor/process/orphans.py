"""Finds what is left of a run whose supervisor is gone: orphans, whose subreaper we are, and what has a mark."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterable
from dataclasses import dataclass

from tutor.process.supervisor import Process, kill, processes

MARK = "ROS_TUTOR_RUN"

supervisors: set[int] = set()
"""Our supervisors, from their start until they are reaped: our children that have a session of their own."""


@dataclass(frozen=True, slots=True)
class RunMarks:
    """What tells a run's processes from all others.

    `run` is the value of `MARK` in their environment; `session` the learner's session (None where its number may have
    been given to someone else since); `pipes` the inodes of the pipes that they write to.
    """

    run: str
    session: int | None
    pipes: frozenset[int]


def find_orphans(marks: RunMarks) -> list[Process]:
    """The living processes that have one of the marks, orphans of any supervisor, and the descendants of both.

    Never ourselves or our ancestors. Orphans that have ended are reaped.
    """
    table = processes()
    spared = set(_ancestors(os.getpid(), table))
    orphans = {p.pid for p in table.values() if _is_orphan(p)}
    for pid in orphans:
        with contextlib.suppress(ChildProcessError):
            os.waitpid(pid, os.WNOHANG)
    chosen = orphans | {p.pid for p in table.values() if p.pid not in spared and _has_mark(p, marks)}
    grew = True
    while grew:
        more = {p.pid for p in table.values() if p.parent in chosen and p.pid not in spared} - chosen
        chosen |= more
        grew = bool(more)
    return [table[pid] for pid in sorted(chosen) if table[pid].alive]


def end_orphans(limit_s: float = 1.0) -> None:
    """Kill what has come to us since the process that looked after it has died, and all that it started."""
    until = time.monotonic() + limit_s
    while (found := find_orphans(RunMarks("", None, frozenset()))) and time.monotonic() < until:
        kill(found)
        time.sleep(0.002)


def command_line(pid: int) -> str:
    """The command line of a process, its words separated by spaces; its short name where it has none."""
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
    """Whether a supervisor was its parent: what we have started ourselves is in our own session, or a supervisor."""
    ours = process.parent == os.getpid() and process.pid not in supervisors
    return ours and process.session != os.getsid(0)


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
            # Our own side holds the same pipes open, but only to read.
            if kind == "pipe" and int(inode[:-1]) in pipes and os.lstat(f"{folder}/{name}").st_mode & 0o200:
                return True
    except OSError:
        pass
    return False
