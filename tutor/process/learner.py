"""A learner's process: started as from a terminal, watched, interrupted, and reliably ended."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

from tutor.errors import EndError, StartError
from tutor.judge.trace import Exit, OutputLine
from tutor.process import memory, orphans
from tutor.process.link import SupervisorLink
from tutor.process.output import Output
from tutor.process.pipe import PipeReader
from tutor.process.spawner import DIRECTLY, Spawner
from tutor.process.stdin import Stdin
from tutor.process.supervisor import pack_request
from tutor.process.wake_time import NextWake

_START_LIMIT_S = 20.0


@dataclass(frozen=True, slots=True)
class Survivor:
    """A live process of a learner's run: the program itself or a descendant. `command` is its command line."""

    pid: int
    command: str


class LearnerProcess:
    """A learner's program and everything that it starts. Created by `LearnerProcess.start`.

    An async context manager that calls `end` on exit.
    """

    def __init__(self, spawner: Spawner, on_change: Callable[[], None] | None, terminal: bool) -> None:
        """Internal: use `start`."""
        self._loop = asyncio.get_running_loop()
        self._on_change = on_change
        self._change_handle: asyncio.Handle | None = None
        self._output = Output()
        self._exit: Exit | None = None
        self._exited: asyncio.Future[None] = self._loop.create_future()
        self._run = uuid.uuid4().hex
        self._oom_kills_before = memory.oom_kills()
        self._fault = ""
        self._killed_for = ""
        with contextlib.ExitStack() as made:
            self._stdin = Stdin(terminal=terminal)
            made.callback(self._stdin.close)
            stdout = PipeReader(lambda data: self._feed("stdout", data))
            made.callback(stdout.close)
            stderr = PipeReader(self._feed_stderr)
            made.pop_all()
        self._stdout, self._stderr = stdout, stderr
        self._link = SupervisorLink(self._run, frozenset((stdout.inode, stderr.inode)), self._set_exit, spawner)
        self._link.gone.add_done_callback(lambda _: self._finish())

    @classmethod
    async def start(
        cls,
        argv: Sequence[str],
        *,
        env: Mapping[str, str],
        cwd: Path,
        terminal: bool = False,
        spawner: Spawner = DIRECTLY,
        on_change: Callable[[], None] | None = None,
    ) -> Self:
        """Start `argv` in the folder `cwd` with exactly the environment `env`, plus our marker variable.

        The program gets its own session and process group, default signal handlers, empty stdin, and pipes for output.
        `terminal`: give it an idle terminal as stdin. `ros2 launch` checks whether stdin is a terminal, where Ctrl+C
        reaches the nodes by itself; otherwise it forwards the signal, and each node would get it twice.
        `spawner`: may fork it, or isolate it. `on_change` is called on the event loop after new output and the exit.
        Raises StartError if the program cannot be started; nothing of the attempt is left then.
        """
        try:
            learner = cls(spawner, on_change, terminal)
        except OSError as error:
            raise StartError(f"The program cannot be started: {error}.") from error
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
    def pid(self) -> int:
        """The process id, which is also the id of its session and process group."""
        return self._link.pid

    @property
    def started_at(self) -> float:
        """When it was started, in seconds since the epoch."""
        return self._link.started_at

    @property
    def exit(self) -> Exit | None:
        """How the process ended, or None while it runs. Once set, everything it wrote is in `output`."""
        return self._exit

    @property
    def killed(self) -> bool:
        """Whether SIGKILL ended it before `end` was called. It may have been self-inflicted; the sender is unknown."""
        return self._exit is not None and self._exit.signal == signal.SIGKILL and not self._link.ending

    @property
    def fault(self) -> str:
        """Why the exit is not the program's doing (out of memory, killed from outside). Empty if no reason is known."""
        return self._link.fault or self._fault

    @property
    def output(self) -> tuple[OutputLine, ...]:
        """The lines written so far (bounded, see `dropped_lines`), including an unfinished last line.

        Decoded again after each change: read it when it is to be shown, not on every `on_change` of a busy process.
        """
        return self._output.lines

    @property
    def dropped_lines(self) -> int:
        """The number of lines dropped from the middle of the output."""
        return self._output.dropped_lines

    def interrupt(self) -> None:
        """Send SIGINT to the process group, as Ctrl+C in a terminal does. Does nothing if the group is gone."""
        self._link.interrupt()

    @property
    def interrupted(self) -> bool:
        """Whether `interrupt` reached the program itself: it had not ended by then."""
        return self._link.interrupted

    async def wait(self, limit_s: float | None) -> Exit | None:
        """Wait up to `limit_s` seconds for the exit (None: indefinitely). Return None if it is still running."""
        await asyncio.wait({self._exited}, timeout=limit_s)
        return self._exit

    def next_wake(self, by: float = 0.0) -> NextWake:
        """Return when a thread of the learner's processes next wakes up by itself, as far as the kernel reports it.

        The search ends at one that wakes up by `by`, in seconds since the epoch.
        """
        return self._link.next_wake(by)

    def survivors(self) -> list[Survivor]:
        """Return the learner's live processes, including the program itself. Zombies do not count."""
        known = [Survivor(p.pid, orphans.command_line(p.pid)) for p in self._link.living_processes()]
        return [survivor for survivor in known if survivor.command]  # one without a command has ended meanwhile

    def pids(self) -> list[int]:
        """Return the pids of all processes of this run, from a recent process table; none once they are gone."""
        return self._link.recent_pids()

    def kill(self, why: str) -> None:
        """Kill all of the learner's processes, and say why in the last line of what the program printed."""
        self._killed_for = why
        self._link.end()

    async def end(self) -> None:
        """Kill all of the learner's processes and wait until none is left. Idempotent.

        Cancellation is delayed until they are gone.
        Raises EndError if some process cannot be killed within a few seconds.
        """
        self._link.end()
        gone = self._link.gone
        cancelled: asyncio.CancelledError | None = None
        while not gone.done():
            try:
                await asyncio.wait({gone})
            except asyncio.CancelledError as error:
                cancelled = error
        self._finish()
        if cancelled is not None:
            raise cancelled
        if gone.result():
            raise EndError(gone.result())

    async def _launch(self, argv: Sequence[str], env: Mapping[str, str], cwd: Path) -> None:
        environment = {**env, orphans.MARK: self._run}
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
            streams = self._stdin.reader, self._stdout.writer, self._stderr.writer
            await self._link.start(request, streams)
        except OSError as error:
            raise StartError(f"The program cannot be started: {error}.") from error
        finally:
            self._stdin.close_reader()
            self._stdout.close_writer()
            self._stderr.close_writer()
        ready = self._link.ready
        await asyncio.wait({ready}, timeout=_START_LIMIT_S)
        if not ready.done():
            raise StartError(f"The program could not be started within {_START_LIMIT_S:.0f} s.")
        if ready.result():
            self._drain()  # a supervisor that crashed printed why
            detail = "".join(f": {line.text}" for line in self.output[-1:])
            raise StartError(f"The program cannot be started: {ready.result()}{detail}.")

    def _feed(self, stream: str, data: bytes) -> None:
        self._output.feed(stream, data, time.time())
        self._schedule_on_change()

    def _feed_stderr(self, data: bytes) -> None:
        self._stdout.catch_up()  # anything printed earlier is in the stdout pipe by now, and belongs above this
        self._feed("stderr", data)

    def _schedule_on_change(self) -> None:
        if self._on_change is not None and self._change_handle is None:
            self._change_handle = self._loop.call_soon(self._call_on_change)

    def _call_on_change(self) -> None:
        self._change_handle = None
        if self._on_change is not None:
            self._on_change()

    def _drain(self) -> None:
        self._stdout.drain()
        self._stderr.drain()

    def _set_exit(self, ended: Exit) -> None:
        # Everything the program wrote is in the pipes by now; its children may hold them open and go on writing.
        self._drain()
        if self._killed_for:
            self._feed("stderr", f"Killed: {self._killed_for}\n".encode())
        self._exit = ended
        if self.killed and memory.oom_kills() > self._oom_kills_before:
            self._fault = "the machine ran out of memory, and the system killed the program"
        self._exited.set_result(None)
        self._schedule_on_change()

    def _finish(self) -> None:
        """Read the remaining output and close everything. Idempotent."""
        self._drain()
        if self._exit is None and self.pid:  # the supervisor was killed, and the program with it
            self._set_exit(Exit(None, int(signal.SIGKILL), max(0.0, time.time() - self.started_at)))
        self._stdin.close()
        self._stdout.close()
        self._stderr.close()
