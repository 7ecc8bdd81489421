"""The process table, read from /proc: who is whose child, and how to end them.

The supervisor uses it, too: it must be imported fast and uses only a few standard modules.
"""

from __future__ import annotations

import contextlib
import os
import signal


class Process:
    """One row of the process table, from /proc/PID/stat."""

    __slots__ = ("group", "parent", "pid", "session", "state")

    def __init__(self, pid: int, state: str, parent: int, group: int, session: int) -> None:
        self.pid = pid
        self.state = state
        self.parent = parent
        self.group = group
        self.session = session

    @property
    def alive(self) -> bool:
        """False for a zombie, unless only its main thread has ended."""
        if self.state not in "ZX":
            return True
        try:
            return len(os.listdir(f"/proc/{self.pid}/task")) > 1
        except OSError:
            return False


def processes() -> dict[int, Process]:
    """Return all visible processes by pid. Not an atomic snapshot: a process may change parents during the scan."""
    table: dict[int, Process] = {}
    for name in os.listdir("/proc"):
        if not name.isdecimal():
            continue
        try:
            with open(f"/proc/{name}/stat", "rb", buffering=0) as file:
                stat = file.read(4096)
        except OSError:
            continue
        # The command name is in parentheses and may contain anything, even parentheses.
        fields = stat[stat.rfind(b")") + 2 :].split(None, 4)
        if len(fields) == 5:
            pid = int(name)
            table[pid] = Process(pid, fields[0].decode(), int(fields[1]), int(fields[2]), int(fields[3]))
    return table


def descendants(root: int) -> list[Process]:
    """Return the descendants of `root`, parents before children, zombies included.

    If a parent ended during the scan, its children have no known parent, and the table is read again.
    """
    for _ in range(5):
        table = processes()
        if all(p.parent == 0 or p.parent in table for p in table.values()):
            break
    return descendants_in(table, root)


def descendants_in(table: dict[int, Process], root: int) -> list[Process]:
    """Return the descendants of `root` in a process table, parents before children."""
    children: dict[int, list[Process]] = {}
    for process in table.values():
        children.setdefault(process.parent, []).append(process)
    found: list[Process] = []
    todo = [root]
    while todo:
        for process in children.pop(todo.pop(0), ()):
            found.append(process)
            todo.append(process.pid)
    return found


def namespace_pid(pid: int) -> int:
    """Return the pid of a process inside its own PID namespace; 0 if it is gone."""
    try:
        with open(f"/proc/{pid}/status", "rb") as file:
            return next((int(line.split()[-1]) for line in file if line.startswith(b"NSpid:")), pid)
    except OSError:
        return 0


def kill(found: list[Process]) -> None:
    """Send SIGKILL to each process, skipping those that are gone or not ours to kill."""
    for process in found:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.kill(process.pid, signal.SIGKILL)
