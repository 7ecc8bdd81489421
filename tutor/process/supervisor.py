"""The supervisor: a small process that starts one learner's process and ensures that nothing of it outlives us.

Run by file path with `python -I -S`, it must start fast: it uses `process_table` and a few standard modules. It is the
subreaper of everything it starts: whatever a descendant does (setsid, double fork, a cleared environment), its ancestry
leads back here, so "the supervisor has no child left" means that nothing is left.

It communicates over one socket; its arguments are that socket's file descriptor and the pid of its owner:

    owner to supervisor   a request (see `pack_request`), then `interrupt` lines. End of stream means: end everything.
                          The stream also ends by itself when the owner dies, even by SIGKILL.
    supervisor to owner   lines: `started PID EPOCH` or `failed SENTENCE`; `exit WAITSTATUS AFTER_S`; `terminated` if a
                          SIGTERM makes it end everything; and finally `ended`.
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

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable

if TYPE_CHECKING or __package__:
    from tutor.process.process_table import descendants, kill
else:  # run by file path, isolated from the folder of this file, or imported by the fork server
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    from process_table import descendants, kill

    del sys.path[0]

PR_SET_PDEATHSIG = 1
PR_SET_DUMPABLE = 4
PR_SET_CHILD_SUBREAPER = 36


def pack_request(argv: list[bytes], environment: list[bytes], cwd: bytes) -> bytes:
    """Encode a request to start `argv`: its length in 8 digits, then NUL-separated parts (no part may hold one)."""
    body = b"\0".join([cwd, str(len(argv)).encode(), *argv, *environment])
    return b"%08d" % len(body) + body


class Supervisor:
    """Starts the learner's process, reports on it, and finally kills and reaps all its descendants."""

    def __init__(
        self,
        control: int,
        owner: int,
        *,
        parent: int | None = None,
        can_run: Callable[[list[bytes], dict[bytes, bytes]], bool] = lambda argv, environment: False,
    ) -> None:
        """`parent`: our parent's pid, if it is not the owner. `can_run`: whether a forked program can run a command.

        It is called in the process that is to run the command, which then has `forked_argv`, and returns from `run`.
        """
        self.forked_argv: list[bytes] | None = None
        self._can_run = can_run
        self._control = control
        os.set_inheritable(control, False)  # like all our other descriptors, so that an exec closes it
        self._main_pid = 0
        self._started_at = 0.0
        self._exited = False
        self._prctl = ctypes.CDLL(None, use_errno=True).prctl
        # End of stream tells us that the owner died, unless a fork of it holds the stream open. Its pidfd is reliable.
        self._owner: int | None = None
        with contextlib.suppress(OSError):
            self._owner = os.pidfd_open(owner)
        self._orphaned = os.getppid() != (parent or owner)
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
        """Handle one request from start to end."""
        self._prctl(PR_SET_DUMPABLE, 0, 0, 0, 0)  # no debugger; undone by the exec of the learner's process
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
        with contextlib.suppress(OSError):  # nobody is left to read it
            os.write(self._control, (line + "\n").encode("utf-8", "replace"))

    def _read_request(self) -> list[bytes] | None:
        data = b""
        while len(data) < 8 or len(data) < 8 + int(data[:8]):
            try:
                more = os.read(self._control, 1 << 16)
            except ConnectionResetError:  # it has given us up, and closed its end before it read our pid
                return None
            if not more:
                return None
            data += more
        # `interrupt` is sent only after `started` has arrived, so nothing can follow the request here.
        return data[8:].split(b"\0")

    def _start(self, argv: list[bytes], environment: dict[bytes, bytes], cwd: bytes) -> bool:
        failure, report = os.pipe()  # both ends are close-on-exec, so a successful exec closes them
        reported, release = os.pipe()  # a forked program could kill us before we have reported its start
        self._started_at = time.monotonic()
        epoch = time.time()
        supervisor = os.getpid()
        try:
            self._main_pid = os.fork()
        except OSError as error:
            self._report(f"failed cannot start a process: {error.strerror}")
            return False
        if self._main_pid == 0:
            os.close(release)
            self._become(argv, environment, cwd, supervisor, report)
            os.read(reported, 1)
            return False
        os.close(report)
        os.close(reported)
        null = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):  # from here on, only the learner's processes hold the pipes and the terminal open
            os.dup2(null, stream)
        os.close(null)
        why = b""
        while chunk := os.read(failure, 4096):
            why += chunk
        os.close(failure)
        if why:
            os.waitpid(self._main_pid, 0)
            self._report(f"failed {why.decode('utf-8', 'replace')}")
            return False
        self._report(f"started {self._main_pid} {epoch!r}")
        os.close(release)
        return True

    def _become(
        self, argv: list[bytes], environment: dict[bytes, bytes], cwd: bytes, supervisor: int, report: int
    ) -> None:
        """Turn this forked child into the learner's process, as a shell in a terminal would start it.

        Returns only if the forked process is to run the command itself.
        """
        try:
            os.setsid()
            if os.isatty(1):  # a shell on a terminal of its own; an idle terminal as stdin alone does not count
                import fcntl
                import termios

                fcntl.ioctl(1, termios.TIOCSCTTY, 0)
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
            if not self._can_run(argv, environment):
                os.execvpe(argv[0], argv, environment)
            os.close(report)
            self.forked_argv = argv
        except BaseException as error:
            text = (error.strerror if isinstance(error, OSError) else None) or str(error)
            name = getattr(error, "filename", None) or argv[0]
            os.write(report, f"{os.fsdecode(name)}: {text}".encode("utf-8", "replace")[:2000])
            os._exit(127)

    def _watch(self) -> None:
        """Handle commands and reap children until the stream or the owner ends."""
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
        """Send SIGINT to the learner's process group, as a terminal does on Ctrl+C; report it if the program lives.

        On SIGINT, a thread of rclpy wakes the main thread and only then shuts the context down. On a busy machine, the
        main thread overtook it in 2 of 100 runs, and a bare `rclpy.shutdown()` after the spin raised nothing. In the
        class SCHED_BATCH, the main thread has as much of the processor as before, but does not preempt its waker. The
        same goes for nodes that a launch file has started.
        """
        group = [p.pid for p in descendants(os.getpid()) if p.group == self._main_pid]
        if not self._exited:  # before it is sent: the program's exit must be reported after it
            self._report("interrupted")
            for pid in group:
                with contextlib.suppress(OSError):
                    os.sched_setscheduler(pid, os.SCHED_BATCH, os.sched_param(0))
        # Once the leader is reaped, its group id is only safe to use while a descendant is still in that group.
        if not self._exited or group:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self._main_pid, signal.SIGINT)

    def _reap(self) -> bool:
        """Reap all children that have ended. Return whether any child is left."""
        with contextlib.suppress(BlockingIOError):
            while os.read(self._wake, 4096):
                pass
        while True:
            try:
                pid, status = os.waitpid(-1, os.WNOHANG)
            except ChildProcessError:
                return False
            if pid == 0:
                return True
            if pid == self._main_pid and not self._exited:
                self._exited = True
                self._report(f"exit {status} {time.monotonic() - self._started_at!r}")

    def _kill_children(self) -> None:
        """Kill our own children and their groups as soon as they are seen.

        Each process of a chain that forks the next and exits has ended before a scan of /proc gets to it, and the
        busier the machine, the longer a scan takes. The list of our children is read in some microseconds.
        """
        pid = os.getpid()
        for _ in range(100):
            try:
                with open(f"/proc/{pid}/task/{pid}/children", "rb", buffering=0) as file:
                    children = file.read(1 << 16).split()
            except OSError:  # a kernel without such lists
                return
            for child in map(int, reversed(children)):  # the newest first
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    _kill_group(os.getpgid(child))
                    os.kill(child, signal.SIGKILL)
            if not self._reap():
                return

    def _end(self) -> None:
        """Kill until no child is left. As the kernel makes every orphan our child, nothing at all is left then."""
        pause = 0.005
        while self._reap():
            self._kill_children()
            found = descendants(os.getpid())
            # A group is killed in one step, which no fork can outrun; single pids cover those outside any known group.
            for group in dict.fromkeys(p.group for p in found):
                _kill_group(group)
            kill(found)
            # The exit of a child wakes us; that of a grandchild does not, hence the timeout.
            select.select([self._wake], [], [], pause)
            pause = min(pause * 1.2, 0.2)  # a process stuck in the kernel is not worth a busy loop


def _kill_group(group: int) -> None:
    """Send SIGKILL to a process group, unless it is our own or one that kill() takes for another."""
    if group not in (0, 1, os.getpgrp()):
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(group, signal.SIGKILL)


if __name__ == "__main__":
    Supervisor(int(sys.argv[1]), int(sys.argv[2])).run()
