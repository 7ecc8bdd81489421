"""The supervisor: a small process that starts one learner's process and sees to it that nothing of it outlives us.

Run by file path with `python -I -S`, so it uses a few standard modules only and must start fast. It is the subreaper of
everything it starts: whatever a descendant does (setsid, double fork, a cleared environment), its parents lead back
here, so "the supervisor has no child left" means that nothing is left.

It talks over one socket, whose file descriptor is its only argument beside our pid:

    us to it       a request (see `pack_request`), then `interrupt` lines; the end of the stream means: end everything.
                   The stream ends by itself when our process dies, SIGKILL included.
    it to us       lines: `started PID EPOCH`, or `failed SENTENCE`; `exit WAITSTATUS AFTER_S`; `terminated`, where a
                   SIGTERM has it end everything; and `ended` as the last.

The functions that read /proc are used on our side too.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import resource
import select
import signal
import sys
import time

PR_SET_PDEATHSIG = 1
PR_SET_DUMPABLE = 4
PR_SET_CHILD_SUBREAPER = 36


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
    """All processes that can be seen, by pid. Not a snapshot of one moment: a process may move while it is read."""
    table: dict[int, Process] = {}
    for name in os.listdir("/proc"):
        if not name.isdecimal():
            continue
        try:
            with open(f"/proc/{name}/stat", "rb", buffering=0) as file:
                stat = file.read(4096)
        except OSError:
            continue
        # The command's name is in parentheses and may hold anything, parentheses included.
        fields = stat[stat.rfind(b")") + 2 :].split(None, 4)
        if len(fields) == 5:
            pid = int(name)
            table[pid] = Process(pid, fields[0].decode(), int(fields[1]), int(fields[2]), int(fields[3]))
    return table


def descendants(root: int) -> list[Process]:
    """The descendants of `root`, parents before children, zombies included.

    A process whose parent ended during the reading has no known parent; then it is read again.
    """
    for _ in range(5):
        table = processes()
        if all(p.parent == 0 or p.parent in table for p in table.values()):
            break
    return descendants_in(table, root)


def descendants_in(table: dict[int, Process], root: int) -> list[Process]:
    """The descendants of `root` in a table of processes, parents before children."""
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
    """The number of a process in the namespace that it is in; 0 where it has gone."""
    try:
        with open(f"/proc/{pid}/status", "rb") as file:
            return next((int(line.split()[-1]) for line in file if line.startswith(b"NSpid:")), pid)
    except OSError:
        return 0


def kill(found: list[Process]) -> None:
    """SIGKILL to each of the processes. One that has gone, or is not ours to kill, is passed over."""
    for process in found:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.kill(process.pid, signal.SIGKILL)


def pack_request(argv: list[bytes], environment: list[bytes], cwd: bytes) -> bytes:
    """Write a request to start `argv`: its length in 8 digits, then its parts between NULs (no part can hold one)."""
    body = b"\0".join([cwd, str(len(argv)).encode(), *argv, *environment])
    return b"%08d" % len(body) + body


class Supervisor:
    """Starts the learner's process, reports on it, and in the end kills and reaps everything that descends from it."""

    def __init__(self, control: int, owner: int) -> None:
        self._control = control
        os.set_inheritable(control, False)  # as all our other descriptors are, so that an exec closes them
        self._main = 0
        self._started = 0.0
        self._exited = False
        self._prctl = ctypes.CDLL(None, use_errno=True).prctl
        # The stream's end says that our owner died; a fork of the owner may hold the stream open, its pidfd cannot lie.
        self._owner: int | None = None
        with contextlib.suppress(OSError):
            self._owner = os.pidfd_open(owner)
        self._orphaned = os.getppid() != owner
        self._wake, wake = os.pipe()
        for end in (self._wake, wake):
            os.set_blocking(end, False)
        signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.signal(signal.SIGTERM, self._on_term)
        for ignored in (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE, signal.SIGUSR1, signal.SIGUSR2):
            signal.signal(ignored, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_SETMASK, [])

    def _on_term(self, *_: object) -> None:
        self._orphaned = True

    def run(self) -> None:
        """Do one request from start to end."""
        self._prctl(PR_SET_DUMPABLE, 0, 0, 0, 0)  # no debugger; the exec of the learner's process takes it back
        if self._prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) != 0:
            return self._report(f"failed the system refused a subreaper: {os.strerror(ctypes.get_errno())}")
        request = self._read_request()
        if request is None:
            return None
        cwd, count, *rest = request
        environment = dict(entry.split(b"=", 1) for entry in rest[int(count) :])
        if self._start(rest[: int(count)], environment, cwd):
            try:
                self._watch()
                if self._orphaned:
                    self._report("terminated")
            finally:
                self._end()
            self._report("ended")
        return None

    def _report(self, line: str) -> None:
        with contextlib.suppress(OSError):  # where nobody is left to hear it
            os.write(self._control, (line + "\n").encode("utf-8", "replace"))

    def _read_request(self) -> list[bytes] | None:
        data = b""
        while len(data) < 8 or len(data) < 8 + int(data[:8]):
            more = os.read(self._control, 1 << 16)
            if not more:
                return None
            data += more
        # `interrupt` is sent only after `started` has arrived, so nothing can follow the request here.
        return data[8:].split(b"\0")

    def _start(self, argv: list[bytes], environment: dict[bytes, bytes], cwd: bytes) -> bool:
        failure, report = os.pipe()  # closed by a successful exec; both ends are close-on-exec
        self._started = time.monotonic()
        epoch = time.time()
        supervisor = os.getpid()
        try:
            self._main = os.fork()
        except OSError as error:
            self._report(f"failed cannot start a process: {error.strerror}")
            return False
        if self._main == 0:
            self._exec(argv, environment, cwd, supervisor, report)
        os.close(report)
        null = os.open(os.devnull, os.O_RDWR)
        for output in (1, 2):  # only the learner's processes hold the pipes open from here on
            os.dup2(null, output)
        os.close(null)
        why = b""
        while chunk := os.read(failure, 4096):
            why += chunk
        os.close(failure)
        if why:
            os.waitpid(self._main, 0)
            self._report(f"failed {why.decode('utf-8', 'replace')}")
            return False
        self._report(f"started {self._main} {epoch!r}")
        return True

    def _exec(
        self, argv: list[bytes], environment: dict[bytes, bytes], cwd: bytes, supervisor: int, report: int
    ) -> None:
        """Turn this fresh child into the learner's process, as a terminal would start it."""
        try:
            os.setsid()
            self._prctl(PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
            if os.getppid() != supervisor:
                os._exit(127)
            signal.set_wakeup_fd(-1)
            for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
                signal.signal(number, signal.SIG_DFL)
            signal.pthread_sigmask(signal.SIG_SETMASK, [])
            hard = resource.getrlimit(resource.RLIMIT_CORE)[1]
            resource.setrlimit(resource.RLIMIT_CORE, (0, hard))  # no core file among the learner's files
            os.chdir(cwd)
            os.execvpe(argv[0], argv, environment)
        except BaseException as error:
            text = (error.strerror if isinstance(error, OSError) else None) or str(error)
            name = getattr(error, "filename", None) or argv[0]
            os.write(report, f"{os.fsdecode(name)}: {text}".encode("utf-8", "replace")[:2000])
        finally:
            os._exit(127)

    def _watch(self) -> None:
        """Serve until the stream or our owner ends, reaping what ends meanwhile."""
        poll = select.poll()
        for source in (self._control, self._wake, self._owner):
            if source is not None:
                poll.register(source, select.POLLIN)
        while not self._orphaned:
            ready = {source for source, _ in poll.poll()}
            self._reap()
            if self._owner in ready:
                return
            if self._control in ready:
                try:
                    commands = os.read(self._control, 4096)
                except OSError:
                    return
                if not commands:
                    return
                for _ in range(commands.count(b"interrupt\n")):
                    self._interrupt()

    def _interrupt(self) -> None:
        """SIGINT to the learner's process group, as a terminal sends it on Ctrl+C."""
        # Once the leader is reaped, its group's number is only safe while a descendant still is in that group.
        if not self._exited or any(p.group == self._main for p in descendants(os.getpid())):
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self._main, signal.SIGINT)

    def _reap(self) -> bool:
        """Reap every child that has ended. Returns whether any child is left, ended or not."""
        try:
            while os.read(self._wake, 4096):
                pass
        except BlockingIOError:
            pass
        while True:
            try:
                pid, status = os.waitpid(-1, os.WNOHANG)
            except ChildProcessError:
                return False
            if pid == 0:
                return True
            if pid == self._main and not self._exited:
                self._exited = True
                self._report(f"exit {status} {time.monotonic() - self._started!r}")

    def _end(self) -> None:
        """Kill until no child is left. The kernel hands us every orphan, so then nothing is left at all."""
        own = os.getpgrp()
        pause = 0.005
        while self._reap():
            found = descendants(os.getpid())
            # A group is killed in one step, which a fork cannot outrun; pids are for those outside any known group.
            for group in dict.fromkeys(p.group for p in found):
                if group not in (0, 1, own):
                    with contextlib.suppress(ProcessLookupError, PermissionError):
                        os.killpg(group, signal.SIGKILL)
            kill(found)
            # A child's end wakes us; the limit is for an end that is a grandchild's, which does not.
            select.select([self._wake], [], [], pause)
            pause = min(pause * 1.2, 0.2)  # what cannot be killed yet (it waits in the kernel) is not worth a busy loop


if __name__ == "__main__":
    Supervisor(int(sys.argv[1]), int(sys.argv[2])).run()
