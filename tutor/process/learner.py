"""A learner's process: started as from a terminal, watched, sent Ctrl+C, and ended for certain."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

from tutor.judge.trace import Exit, OutputLine
from tutor.process import sweep
from tutor.process.output import Output
from tutor.process.pipe import PipeReader
from tutor.process.warden import descendants, kill, pack_request

_WARDEN = Path(__file__).with_name("warden.py")
_START_LIMIT_S = 20.0
# How long the warden may take to end everything before we step in, and how long we then may take.
_WARDEN_LIMIT_S = 3.0
_SWEEP_LIMIT_S = 5.0


class ProcessError(Exception):
    """A fault of ours or of the machine in handling a process; its text is a clear sentence."""


class StartError(ProcessError):
    """The process could not be started."""


class EndError(ProcessError):
    """Some process could not be ended, although SIGKILL was sent to it."""


@dataclass(frozen=True, slots=True)
class Survivor:
    """A living process that the learner's process started (or that process itself). `command` is its command line."""

    pid: int
    command: str


class LearnerProcess:
    """One process of a learner, with everything that it starts. Made by `LearnerProcess.start`.

    An asynchronous context manager: leaving it calls `end`.
    """

    def __init__(self, on_change: Callable[[], None] | None) -> None:
        """Not for callers: use `start`."""
        self.pid = 0
        """The process id, which is also its session's and its process group's."""
        self.started_at = 0.0
        """When it was started, in seconds since the epoch."""
        self._loop = asyncio.get_running_loop()
        self._on_change = on_change
        self._change: asyncio.Handle | None = None
        self._run = uuid.uuid4().hex
        self._output = Output()
        self._pipes: tuple[PipeReader, ...] = ()
        self._warden: subprocess.Popen[bytes] | None = None
        self._control: asyncio.Transport | None = None
        self._last_word = False
        self._ending = False
        self._step_in: asyncio.TimerHandle | None = None
        self._exit: Exit | None = None
        self._ready: asyncio.Future[str] = self._loop.create_future()  # a reason why not, or empty
        self._exited: asyncio.Future[None] = self._loop.create_future()
        self._gone: asyncio.Future[str] = self._loop.create_future()  # what could not be ended, or empty

    @classmethod
    async def start(
        cls,
        argv: Sequence[str],
        *,
        env: Mapping[str, str],
        cwd: Path,
        on_change: Callable[[], None] | None = None,
    ) -> Self:
        """Start `argv` with exactly the environment `env` (and a mark of ours) in the folder `cwd`.

        It gets a session and process group of its own, default signal handling, no input, and pipes for its output.
        `on_change` is called on the event loop after new output and after the exit.
        Raises StartError if it cannot be started; then nothing is left of the attempt.
        """
        learner = cls(on_change)
        try:
            await learner._launch(argv, env, cwd)
        except BaseException:
            await learner.end()
            raise
        return learner

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.end()

    @property
    def exit(self) -> Exit | None:
        """How the process ended; None while it lives. Once set, all that it wrote is in `output`."""
        return self._exit

    @property
    def output(self) -> tuple[OutputLine, ...]:
        """The lines it wrote so far (bounded, see `dropped_lines`), an unfinished last line included.

        Decoded anew after each change, so look when it is to be shown, not on each `on_change` of a busy process.
        """
        return self._output.lines

    @property
    def dropped_lines(self) -> int:
        """How many lines in the middle of the output were not kept."""
        return self._output.dropped_lines

    def interrupt(self) -> None:
        """Send SIGINT to the process group, as Ctrl+C in a terminal does. Nothing happens if the group is gone."""
        if self._control is not None and not self._ending and not self._control.is_closing():
            self._control.write(b"interrupt\n")

    async def wait(self, limit_s: float | None) -> Exit | None:
        """Wait for the exit, `limit_s` seconds at most (None: as long as it takes). None if it still lives."""
        await asyncio.wait({self._exited}, timeout=limit_s)
        return self._exit

    async def survivors(self) -> list[Survivor]:
        """The living processes of the learner's, the first one included while it lives; zombies do not count."""
        if self._gone.done() or self._warden is None:
            return []
        found = [p for p in descendants(self._warden.pid) if p.alive] or sweep.find(self._marks())
        known = [Survivor(p.pid, sweep.command(p.pid)) for p in found if p.pid != self._warden.pid]
        return [survivor for survivor in known if survivor.command]

    async def end(self) -> None:
        """Kill every process of the learner's and wait until none is left. May be called more than once.

        A cancelled caller gets its CancelledError only when that is done.
        Raises EndError if something cannot be killed within some seconds.
        """
        self._begin_end()
        cancelled: asyncio.CancelledError | None = None
        while not self._gone.done():
            try:
                await asyncio.wait({self._gone})
            except asyncio.CancelledError as error:
                cancelled = error
        if cancelled is not None:
            raise cancelled
        if self._gone.result():
            raise EndError(self._gone.result())

    # --- starting ---

    async def _launch(self, argv: Sequence[str], env: Mapping[str, str], cwd: Path) -> None:
        environment = {**env, sweep.MARK: self._run}
        if not argv or any("\0" in text for text in (*argv, *environment.values(), str(cwd))):
            raise StartError("The program cannot be started: its command is empty or holds a NUL character.")
        if any(not name or "=" in name or "\0" in name for name in environment):
            raise StartError("The program cannot be started: an environment variable has an impossible name.")
        request = pack_request(
            [os.fsencode(word) for word in argv],
            [os.fsencode(f"{name}={value}") for name, value in environment.items()],
            os.fsencode(os.path.abspath(cwd)),
        )
        try:
            await self._start_warden()
            assert self._control is not None
            self._control.write(request)
        except OSError as error:
            raise StartError(f"The program cannot be started: {error}.") from error
        await asyncio.wait({self._ready}, timeout=_START_LIMIT_S)
        if not self._ready.done():
            raise StartError(f"The program could not be started within {_START_LIMIT_S:.0f} s.")
        if self._ready.result():
            raise StartError(f"The program cannot be started: {self._ready.result()}.")

    async def _start_warden(self) -> None:
        stdout = PipeReader(lambda data: self._take("stdout", data))
        self._pipes = (stdout,)
        stderr = PipeReader(lambda data: self._take("stderr", data))
        self._pipes = (stdout, stderr)
        ours, theirs = socket.socketpair()
        try:
            self._warden = subprocess.Popen(
                [sys.executable, "-I", "-S", str(_WARDEN), str(theirs.fileno()), str(os.getpid())],
                stdin=subprocess.DEVNULL,
                stdout=stdout.writer,
                stderr=stderr.writer,
                pass_fds=(theirs.fileno(),),
                cwd="/",
                # The ROS wheels would have the interpreter start twice.
                env={**os.environ, "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"},
                start_new_session=True,
            )
        except OSError:
            ours.close()
            raise
        finally:
            theirs.close()
            stdout.close_writer()
            stderr.close_writer()
        try:
            transport, _ = await self._loop.create_unix_connection(lambda: _Control(self._hear, self._lost), sock=ours)
        except BaseException:
            ours.close()  # tells the warden to end
            self._lost()
            raise
        self._control = transport

    # --- listening ---

    def _take(self, stream: str, data: bytes) -> None:
        self._output.feed(stream, data, time.time())
        self._changed()

    def _changed(self) -> None:
        if self._on_change is not None and self._change is None:
            self._change = self._loop.call_soon(self._tell)

    def _tell(self) -> None:
        self._change = None
        if self._on_change is not None:
            self._on_change()

    def _hear(self, line: str) -> None:
        word, _, rest = line.partition(" ")
        if word == "started":
            pid, epoch = rest.split()
            self.pid, self.started_at = int(pid), float(epoch)
            self._set_ready("")
        elif word == "failed":
            self._last_word = True
            self._set_ready(rest)
        elif word == "exit":
            status, after_s = rest.split()
            code = os.waitstatus_to_exitcode(int(status))
            self._set_exit(Exit(code if code >= 0 else None, -code if code < 0 else None, float(after_s)))
        elif word == "ended":
            self._last_word = True

    def _set_ready(self, why_not: str) -> None:
        if not self._ready.done():
            self._ready.set_result(why_not)

    def _set_exit(self, ended: Exit) -> None:
        # All that the process itself wrote is in the pipes by now; others may hold them open and go on writing.
        for pipe in self._pipes:
            pipe.drain()
        self._exit = ended
        self._exited.set_result(None)
        self._changed()

    # --- ending ---

    def _begin_end(self) -> None:
        if self._ending or self._gone.done():
            return
        self._ending = True
        if self._warden is None:
            self._finish("")
        elif self._control is not None and not self._control.is_closing():
            self._warden.send_signal(signal.SIGCONT)  # should a learner's program have stopped it
            self._control.write_eof()
            self._step_in = self._loop.call_later(_WARDEN_LIMIT_S, self._take_over)

    def _take_over(self) -> None:
        """The warden does not get it done: do without it. Its end makes `_lost` sweep up the rest."""
        if self._warden is not None and not self._gone.done():
            with contextlib.suppress(OSError):  # /proc cannot be read, say with no descriptor left; the sweep tries on
                kill(descendants(self._warden.pid))
            self._warden.kill()

    def _lost(self) -> None:
        """The warden is gone: after its last word all is well; else its charges are orphans, to be found by marks."""
        if self._last_word:
            self._finish("")
        else:
            self._sweep(self._marks(), self._loop.time() + _SWEEP_LIMIT_S, clean=0)

    def _marks(self) -> sweep.Marks:
        # After the process was reaped, the number of its session may be someone else's.
        session = self.pid if self.pid and self._exit is None else None
        return sweep.Marks(self._run, session, frozenset(pipe.inode for pipe in self._pipes))

    def _sweep(self, marks: sweep.Marks, until: float, clean: int) -> None:
        try:
            found = [p for p in sweep.find(marks) if self._warden is None or p.pid != self._warden.pid]
            left = ", ".join(f"{p.pid} ({sweep.command(p.pid)})" for p in found)
        except OSError as error:
            found, left = [], f"those there may be, since the system does not show them ({error})"
        kill(found)
        clean = 0 if left else clean + 1
        if clean >= 2:  # one look alone could miss a child whose parent ended during the look
            self._finish("")
        elif self._loop.time() > until:
            self._finish(f"Some processes of the program could not be ended: {left}.")
        else:
            self._loop.call_later(0.005, self._sweep, marks, until, clean)

    def _finish(self, left: str) -> None:
        if self._warden is not None and self._warden.poll() is None:
            self._loop.call_later(0.001, self._finish, left)  # it has closed its files, so it is about to be gone
            return
        for pipe in self._pipes:
            pipe.drain()
        if not self._ready.done():
            said = " ".join(line.text for line in self._output.lines[-3:])
            self._set_ready(f"our helper process ended at once{': ' if said else ''}{said}")
        if self._exit is None and self.pid:  # the warden took it along
            self._set_exit(Exit(None, int(signal.SIGKILL), max(0.0, time.time() - self.started_at)))
        for pipe in self._pipes:
            pipe.close()
        if self._step_in is not None:
            self._step_in.cancel()
        if not self._gone.done():
            self._gone.set_result(left)


class _Control(asyncio.Protocol):
    """Our end of the socket to the warden: hands on its lines, and that it is gone."""

    def __init__(self, hear: Callable[[str], None], lost: Callable[[], None]) -> None:
        self._hear = hear
        self._on_lost = lost
        self._rest = b""

    def data_received(self, data: bytes) -> None:
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            self._hear(line.decode("utf-8", "replace"))

    def connection_lost(self, error: Exception | None) -> None:
        self._on_lost()
