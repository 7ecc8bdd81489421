"""A program on a pseudo-terminal of its own: typed to, read from, resized, and hung up. Nothing of it outlives us."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import fcntl
import os
import struct
import termios
import uuid
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Self

from tutor.errors import EndError, StartError
from tutor.judge.trace import Exit
from tutor.process import orphans
from tutor.process.link import SupervisorLink
from tutor.process.supervisor import pack_request

HANGUP_S = 1.0
"""How long the program may take to exit once its terminal is closed, before all of it is killed."""

READ_BYTES, READ_INTERVAL_S = 1 << 16, 0.015
"""At most this much is read at once, and from a program that goes on writing, no more often than this.

A flood waits in the program, not in our memory; and a message at 1 kHz costs no wake-up of ours each.
"""

MAX_UNWRITTEN_BYTES = 1 << 20
"""How much may wait for a program that does not read. What is typed or pasted beyond that is dropped."""

_START_LIMIT_S = 20.0
_KILLED = Exit(None, 9, 0.0)
_LOCAL_FLAGS = 3


class TerminalProgram:
    """A program and everything it starts, with a pseudo-terminal as controlling terminal. Created by `start`."""

    def __init__(
        self, size: tuple[int, int], on_output: Callable[[bytes], object], on_exit: Callable[[], object]
    ) -> None:
        """Internal: use `start`."""
        self._loop = asyncio.get_running_loop()
        self._on_output, self._on_exit = on_output, on_exit
        self._unwritten = bytearray()
        self._resume: asyncio.TimerHandle | None = None
        self._read_at = 0.0
        self.exit: Exit | None = None
        """How the program ended; None while it runs."""
        self._exited = asyncio.Event()
        self._run = uuid.uuid4().hex
        self._link = SupervisorLink(self._run, frozenset(), self._set_exit)
        self._link.gone.add_done_callback(lambda _: self._set_exit(_KILLED) if self.exit is None else None)
        self._master, self._slave = os.openpty()
        os.set_blocking(self._master, False)
        self.resize(size)

    @classmethod
    async def start(
        cls,
        argv: Sequence[str],
        *,
        env: Mapping[str, str],
        cwd: Path,
        size: tuple[int, int],
        on_output: Callable[[bytes], object],
        on_exit: Callable[[], object],
    ) -> Self:
        """Start `argv` in the folder `cwd`, with exactly the environment `env`, plus our marker variable.

        `size`: of the terminal, as columns and rows. `on_output` is called on the event loop with what the program
        writes, `on_exit` after its exit. Raises StartError; nothing of the attempt is left then.
        """
        try:
            program = cls(size, on_output, on_exit)
        except OSError as error:
            raise StartError(f"No terminal can be opened: {error.strerror or error}.") from error
        try:
            await program._launch(argv, {**env, orphans.MARK: program._run}, cwd)
        except BaseException:
            await program.end()
            raise
        return program

    async def _launch(self, argv: Sequence[str], env: Mapping[str, str], cwd: Path) -> None:
        request = pack_request(
            [os.fsencode(word) for word in argv],
            [os.fsencode(f"{name}={value}") for name, value in env.items()],
            os.fsencode(cwd),
        )
        try:
            await self._link.start(request, (self._slave, self._slave, self._slave))
        except OSError as error:
            raise StartError(f"The program cannot be started: {error}.") from error
        finally:
            os.close(self._slave)
        ready = self._link.ready
        await asyncio.wait({ready}, timeout=_START_LIMIT_S)
        if not ready.done() or ready.result():
            raise StartError(
                f"The program cannot be started: {ready.result() if ready.done() else 'it took too long'}."
            )
        self._loop.add_reader(self._master, self._read)

    @property
    def pid(self) -> int:
        """The process id, which is also the id of its session and process group."""
        return self._link.pid

    @property
    def foreground(self) -> int:
        """The process group that gets the keys; 0 if there is none."""
        if self._master < 0:
            return 0
        try:
            return os.tcgetpgrp(self._master)
        except OSError:
            return 0

    @property
    def reads_keys(self) -> bool:
        """Whether the program itself, not one it has started, reads single keys: a shell is at its prompt then."""
        if self.foreground != self.pid:
            return False
        try:
            return not termios.tcgetattr(self._master)[_LOCAL_FLAGS] & termios.ICANON
        except termios.error:
            return False

    def write(self, data: bytes) -> None:
        """Type something to the program; it is held back while the program does not read."""
        if self._master < 0 or len(self._unwritten) + len(data) > MAX_UNWRITTEN_BYTES:
            return
        self._unwritten += data
        self._write()

    def resize(self, size: tuple[int, int]) -> None:
        """Set the size of the terminal, as columns and rows; the kernel tells the programs on it (SIGWINCH)."""
        if self._master >= 0:
            columns, rows = size
            fcntl.ioctl(self._master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    async def end(self) -> None:
        """Close the terminal (SIGHUP), and kill what is left after a moment. Idempotent.

        Raises EndError if some process cannot be killed within a few seconds.
        """
        self._hang_up()
        try:
            if self.pid and self.exit is None:
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(self._exited.wait(), HANGUP_S)
        finally:
            self._link.end()
        await asyncio.wait({self._link.gone})
        if why := self._link.gone.result():
            raise EndError(why)

    def _read(self) -> None:
        """Read what is there, within bounds."""
        found, closed = bytearray(), False
        while len(found) < READ_BYTES and not closed:
            try:
                data = os.read(self._master, READ_BYTES)
            except BlockingIOError:
                break
            except OSError:  # EIO: no process has the terminal open
                data = b""
            closed = not data
            found += data
        now = self._loop.time()
        goes_on = now - self._read_at < 2 * READ_INTERVAL_S or len(found) >= READ_BYTES
        self._read_at = now
        if closed or goes_on:
            self._loop.remove_reader(self._master)
        if goes_on and not closed and self._resume is None:
            self._resume = self._loop.call_later(READ_INTERVAL_S, self._read_again)
        if found:
            self._on_output(bytes(found))

    def _read_again(self) -> None:
        self._resume = None
        if self._master >= 0:
            self._loop.add_reader(self._master, self._read)

    def _write(self) -> None:
        try:
            while self._unwritten:
                del self._unwritten[: os.write(self._master, self._unwritten)]
        except BlockingIOError:
            self._loop.add_writer(self._master, self._write)
            return
        except OSError as error:
            if error.errno != errno.EIO:
                raise
            self._unwritten.clear()
        self._loop.remove_writer(self._master)

    def _set_exit(self, ended: Exit) -> None:
        if self._master >= 0 and self._resume is None:
            self._read()  # its last words
        self.exit = ended
        self._exited.set()
        self._on_exit()

    def _hang_up(self) -> None:
        if self._resume is not None:
            self._resume.cancel()
        if self._master >= 0:
            self._loop.remove_reader(self._master)
            self._loop.remove_writer(self._master)
            os.close(self._master)
            self._master = -1
