"""Our end of a supervisor: starts it, sends it requests, handles its reports, and takes over if it fails."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from collections.abc import Callable

from tutor.judge.trace import Exit
from tutor.process import orphans, prctl
from tutor.process.cpu_wait import recent_processes
from tutor.process.process_table import Process, descendants, descendants_in, kill, namespace_pid
from tutor.process.spawner import DIRECTLY, Spawner, SupervisorProcess
from tutor.process.wake_time import NextWake, next_wake

# How long the supervisor may take to end everything before we take over, and how long we may then take.
_SUPERVISOR_LIMIT_S = 3.0
_ORPHANS_LIMIT_S = 5.0

_KILLED = "the ros-tutor process that looks after the program was killed, and the program with it"


class SupervisorLink(asyncio.Protocol):
    """The connection to one supervisor, and so to one learner process and its descendants.

    The future `ready` resolves to "" once the process has started, or to the reason why it cannot. The future `gone`
    resolves to "" once the supervisor and all its processes are gone, or to a list of those that could not be ended.
    """

    def __init__(
        self, run: str, pipes: frozenset[int], on_exit: Callable[[Exit], None], spawner: Spawner = DIRECTLY
    ) -> None:
        """`run` and `pipes` identify the processes of this run (see `orphans.RunMarks`)."""
        self.pid = 0
        self.started_at = 0.0
        self.fault = ""
        """Why the exit is not the program's doing: the supervisor was killed from outside. Empty if it was not."""
        self.ending = False
        self.interrupted = False
        """Whether SIGINT was sent while the program was running."""
        self._loop = asyncio.get_running_loop()
        self.ready: asyncio.Future[str] = self._loop.create_future()
        self.gone: asyncio.Future[str] = self._loop.create_future()
        self._spawner = spawner
        self._run = run
        self._pipes = pipes
        self._on_exit = on_exit
        self._exited = False
        self._supervisor: SupervisorProcess | None = None
        self._control: asyncio.Transport | None = None
        self._received = b""
        self._finished = False
        self._ours: set[int] = set()  # the supervisor, and any wrapper processes around it
        self._takeover_timer: asyncio.TimerHandle | None = None

    async def start(self, request: bytes, streams: tuple[int, int, int]) -> None:
        """Start the supervisor and send it a request. It and its processes share these stdin, stdout and stderr.

        Raises OSError if the supervisor cannot be started.
        """
        prctl.guard()
        prctl.adopt_orphans(True)
        self._supervisor, ours = await self._spawner.spawn(streams)
        orphans.supervisors.add(self._supervisor.pid)
        self._ours.add(self._supervisor.pid)
        try:
            self._control, _ = await self._loop.create_unix_connection(lambda: self, sock=ours)
        except BaseException:
            ours.close()  # end of stream: the supervisor exits
            self.connection_lost(None)
            raise
        self._control.write(request)

    def interrupt(self) -> None:
        """Ask the supervisor to send SIGINT to the learner's process group."""
        if self._control is not None and not self.ending and not self._control.is_closing():
            self._control.write(b"interrupt\n")

    def living_processes(self) -> list[Process]:
        """Return the live processes under the supervisor."""
        if self._supervisor is None or self.gone.done():
            return []
        found = [p for p in descendants(self._supervisor.pid) if p.alive] or orphans.find_orphans(self._marks())
        return [p for p in found if p.pid not in self._ours]

    def recent_pids(self) -> list[int]:
        """Return the pids of the processes under the supervisor, from a recent process table; none once it is gone."""
        return [process.pid for process in self._recent_processes()]

    def next_wake(self, by: float = 0.0) -> NextWake:
        """Return when a thread of the processes under the supervisor next wakes up by itself; see `next_wake`."""
        found = self._recent_processes()
        return next_wake((p.pid for p in found if p.alive and p.pid not in self._ours), by)

    def _recent_processes(self) -> list[Process]:
        if self._supervisor is None or self.gone.done():
            return []
        return descendants_in(recent_processes(self._supervisor.pid), self._supervisor.pid)

    def end(self) -> None:
        """Start ending everything; `gone` resolves when that is done. Idempotent."""
        if self.ending or self.gone.done():
            return
        self.ending = True
        if self._supervisor is None:
            self.gone.set_result("")
        elif self._control is not None and not self._control.is_closing():
            for pid in self._ours:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGCONT)  # in case a learner's program has stopped it
            self._control.write_eof()
            self._takeover_timer = self._loop.call_later(_SUPERVISOR_LIMIT_S, self._take_over)

    # --- reports from the supervisor (called by asyncio) ---

    def data_received(self, data: bytes) -> None:
        *lines, self._received = (self._received + data).split(b"\n")
        for line in lines:
            word, _, rest = line.decode("utf-8", "replace").partition(" ")
            self._handle_report(word, rest)

    def connection_lost(self, error: Exception | None) -> None:
        """Finish if the supervisor has sent its last report; otherwise its processes are orphans, and ours to end."""
        if self.pid and not self.ending:
            self.fault = _KILLED
        if self._finished:
            self._finish("")
        else:
            if self._supervisor is not None:
                self._spawner.kill_namespace(self._supervisor)
            self._end_orphans(self._marks(), self._loop.time() + _ORPHANS_LIMIT_S, clean_scans=0)

    def _handle_report(self, word: str, rest: str) -> None:
        if word == "started":
            pid, epoch = rest.split()
            self.pid, self.started_at = int(pid), float(epoch)
            if self._spawner.wrapper:
                self.pid = self._translate_pid(self.pid)
            self._set_ready("")
        elif word == "failed":
            self._finished = True
            self._set_ready(rest)
        elif word == "exit":
            status, after_s = rest.split()
            code = os.waitstatus_to_exitcode(int(status))
            self._exited = True
            self._on_exit(Exit(code if code >= 0 else None, -code if code < 0 else None, float(after_s)))
        elif word == "interrupted":
            self.interrupted = True
        elif word == "terminated":
            self.fault = _KILLED
        elif word == "ended":
            self._finished = True

    def _translate_pid(self, pid: int) -> int:
        """Translate a pid reported from inside the supervisor's PID namespace to the one it has in ours."""
        assert self._supervisor is not None
        found = {p.pid: p for p in descendants(self._supervisor.pid)}
        outer_pid = next((p for p in found if namespace_pid(p) == pid), None)
        if outer_pid is None:  # it has already ended and been reaped
            return self._supervisor.pid
        above = found[outer_pid].parent
        while above in found:
            self._ours.add(above)
            above = found[above].parent
        return outer_pid

    def _set_ready(self, why_not: str) -> None:
        if not self.ready.done():
            self.ready.set_result(why_not)

    # --- when the supervisor fails ---

    def _take_over(self) -> None:
        """Kill a supervisor that takes too long. Once it is gone, the orphans are ended."""
        if self._supervisor is not None and not self.gone.done():
            # If /proc cannot be read (no file descriptors left, say), the search for orphans will try again.
            with contextlib.suppress(OSError):
                kill(descendants(self._supervisor.pid))
            self._supervisor.kill()

    def _marks(self) -> orphans.RunMarks:
        # Once the process has been reaped, its session id may be reused by someone else.
        return orphans.RunMarks(self._run, self.pid if self.pid and not self._exited else None, self._pipes)

    def _end_orphans(self, marks: orphans.RunMarks, until: float, clean_scans: int) -> None:
        try:
            found = [
                p for p in orphans.find_orphans(marks) if self._supervisor is None or p.pid != self._supervisor.pid
            ]
            left = ", ".join(f"{p.pid} ({orphans.command_line(p.pid)})" for p in found)
        except OSError as error:
            found, left = [], f"any that are left, since the system does not list them ({error})"
        kill(found)
        clean_scans = 0 if left else clean_scans + 1
        if clean_scans >= 2:  # a single scan could miss a child whose parent ended during it
            self._finish("")
        elif self._loop.time() > until:
            self._finish(f"Some processes of the program could not be ended: {left}.")
        else:
            self._loop.call_later(0.005, self._end_orphans, marks, until, clean_scans)

    def _finish(self, left: str) -> None:
        if self._supervisor is not None and self._supervisor.poll() is None:
            self._loop.call_later(0.001, self._finish, left)  # it has closed its socket and is about to exit
            return
        if self._supervisor is not None:
            orphans.supervisors.discard(self._supervisor.pid)
        if self._takeover_timer is not None:
            self._takeover_timer.cancel()
        if not self.gone.done():
            self.gone.set_result(left)
        self._set_ready("our helper process ended at once")
