"""A learner's process: started as from a terminal, watched, sent Ctrl+C, and ended for certain."""

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
from tutor.process.stdin import Stdin
from tutor.process.supervisor import pack_request
from tutor.process.wake_time import NextWake

_START_LIMIT_S = 20.0


@dataclass(frozen=True, slots=True)
class Survivor:
    """A living process that the learner's process started (or that process itself). `command` is its command line."""

    pid: int
    command: str


class LearnerProcess:
    """One process of a learner, with everything that it starts. Made by `LearnerProcess.start`.

    An asynchronous context manager: leaving it calls `end`.
    """

    def __init__(self, on_change: Callable[[], None] | None, terminal: bool) -> None:
        """Not for callers: use `start`."""
        self._loop = asyncio.get_running_loop()
        self._on_change = on_change
        self._change: asyncio.Handle | None = None
        self._output = Output()
        self._exit: Exit | None = None
        self._exited: asyncio.Future[None] = self._loop.create_future()
        self._run = uuid.uuid4().hex
        self._out_of_memory = memory.oom_kills()
        self._fault = ""
        with contextlib.ExitStack() as made:
            self._stdin = Stdin(terminal=terminal)
            made.callback(self._stdin.close)
            stdout = PipeReader(lambda data: self._take("stdout", data))
            made.callback(stdout.close)
            stderr = PipeReader(self._take_stderr)
            made.pop_all()
        self._stdout, self._stderr = stdout, stderr
        self._link = SupervisorLink(self._run, frozenset((stdout.inode, stderr.inode)), self._set_exit)
        self._link.gone.add_done_callback(lambda _: self._finish())

    @classmethod
    async def start(
        cls,
        argv: Sequence[str],
        *,
        env: Mapping[str, str],
        cwd: Path,
        terminal: bool = False,
        wrapper: Sequence[str] = (),
        on_change: Callable[[], None] | None = None,
    ) -> Self:
        """Start `argv` with exactly the environment `env` (and our mark) in the folder `cwd`.

        It gets a session and process group of its own, default signal handling, no input, and pipes for its output.
        `terminal`: its input is a terminal where nobody types. `ros2 launch` looks there whether Ctrl+C reaches the
        nodes without its help; where it does not, each node would get two.
        `wrapper`: the command that runs it (see `SupervisorLink.start`).
        `on_change` is called on the event loop after new output and after the exit.
        Raises StartError if it cannot be started; then nothing is left of the attempt.
        """
        try:
            learner = cls(on_change, terminal)
        except OSError as error:
            raise StartError(f"The program cannot be started: {error}.") from error
        try:
            await learner._launch(argv, env, cwd, wrapper)
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
        """The process id, which is also its session's and its process group's."""
        return self._link.pid

    @property
    def started_at(self) -> float:
        """When it was started, in seconds since the epoch."""
        return self._link.started_at

    @property
    def exit(self) -> Exit | None:
        """How the process ended; None while it lives. Once set, all that it wrote is in `output`."""
        return self._exit

    @property
    def killed(self) -> bool:
        """Whether it ended with SIGKILL before it was to `end`: by itself, or by others, which cannot be told apart."""
        return self._exit is not None and self._exit.signal == signal.SIGKILL and not self._link.ending

    @property
    def fault(self) -> str:
        """Why its exit says nothing about the program: the machine or others ended it. Empty where nothing is known."""
        return self._link.fault or self._fault

    @property
    def output(self) -> tuple[OutputLine, ...]:
        """The lines it wrote so far (bounded, see `dropped_lines`), an unfinished last line included.

        Decoded again after each change, so look when it is to be shown, not on each `on_change` of a busy process.
        """
        return self._output.lines

    @property
    def dropped_lines(self) -> int:
        """How many lines in the middle of the output were not kept."""
        return self._output.dropped_lines

    def interrupt(self) -> None:
        """Send SIGINT to the process group, as Ctrl+C in a terminal does. Nothing happens if the group is gone."""
        self._link.interrupt()

    async def wait(self, limit_s: float | None) -> Exit | None:
        """Wait for the exit, `limit_s` seconds at most (None: as long as it takes). None if it still lives."""
        await asyncio.wait({self._exited}, timeout=limit_s)
        return self._exit

    def next_wake(self) -> NextWake:
        """When one of the learner's processes next does something by itself, as far as the kernel tells."""
        return self._link.next_wake()

    async def survivors(self) -> list[Survivor]:
        """The living processes of the learner's, the first one included while it lives; zombies do not count."""
        known = [Survivor(p.pid, orphans.command_line(p.pid)) for p in self._link.living_processes()]
        return [survivor for survivor in known if survivor.command]  # one without has ended meanwhile

    async def end(self) -> None:
        """Kill every process of the learner's and wait until none is left. May be called more than once.

        A cancelled caller gets its CancelledError only when that is done.
        Raises EndError if something cannot be killed within some seconds.
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

    async def _launch(self, argv: Sequence[str], env: Mapping[str, str], cwd: Path, wrapper: Sequence[str]) -> None:
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
            await self._link.start(request, self._stdin.reader, self._stdout.writer, self._stderr.writer, wrapper)
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
            self._drain()  # what a supervisor said that failed itself
            said = "".join(f": {line.text}" for line in self.output[-1:])
            raise StartError(f"The program cannot be started: {ready.result()}{said}.")

    def _take(self, stream: str, data: bytes) -> None:
        self._output.feed(stream, data, time.time())
        self._changed()

    def _take_stderr(self, data: bytes) -> None:
        self._stdout.catch_up()  # what was printed before this is in its pipe by now, and is shown above it
        self._take("stderr", data)

    def _changed(self) -> None:
        if self._on_change is not None and self._change is None:
            self._change = self._loop.call_soon(self._tell)

    def _tell(self) -> None:
        self._change = None
        if self._on_change is not None:
            self._on_change()

    def _drain(self) -> None:
        self._stdout.drain()
        self._stderr.drain()

    def _set_exit(self, ended: Exit) -> None:
        # All that the process itself wrote is in the pipes by now; others may hold them open and go on writing.
        self._drain()
        self._exit = ended
        if self.killed and memory.oom_kills() > self._out_of_memory:
            self._fault = "the machine ran out of memory, and the system killed the program"
        self._exited.set_result(None)
        self._changed()

    def _finish(self) -> None:
        """All is over: read what is left, and close. May be called twice."""
        self._drain()
        if self._exit is None and self.pid:  # the supervisor was killed and took it along
            self._set_exit(Exit(None, int(signal.SIGKILL), max(0.0, time.time() - self.started_at)))
        self._stdin.close()
        self._stdout.close()
        self._stderr.close()
