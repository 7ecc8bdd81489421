"""A child process and its output, on asyncio."""

from __future__ import annotations

import asyncio
import codecs
import contextlib
import os
import pty
import signal
from collections.abc import Callable, Mapping, Sequence
from typing import Any, cast


class Lines:
    """Splits output into lines, without line ends. Undecodable bytes become replacement characters."""

    def __init__(self, show: Callable[[str], None]) -> None:
        self._show = show
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._rest = ""
        self._kept: list[str] = []

    @property
    def text(self) -> str:
        """All output that was kept."""
        return "".join(self._kept)

    def feed(self, data: bytes, *, keep: bool = False) -> None:
        """Process some bytes; with `keep`, add them to `text`."""
        text = self._decoder.decode(data)
        if keep:
            self._kept.append(text)
        *lines, self._rest = (self._rest + text).split("\n")
        for line in lines:
            self._show(line.removesuffix("\r"))

    def flush(self) -> None:
        """Show an unfinished last line."""
        rest = self._rest + self._decoder.decode(b"", final=True)
        self._rest = ""
        self._decoder.reset()
        if rest:
            self._show(rest)


Listener = Callable[[bytes], None]
OUTPUT_AFTER_EXIT_S = 0.2
"""How long to keep reading after a process has exited but one of its children holds its pipes open."""


class _Pipes(asyncio.SubprocessProtocol):
    """Passes on the process once it has started, then its output from the pipes."""

    def __init__(self, on_start: Callable[[Process], None], on_stdout: Listener, on_stderr: Listener) -> None:
        loop = asyncio.get_running_loop()
        self._on_start = on_start
        self._listeners = {1: on_stdout, 2: on_stderr}
        self.exited: asyncio.Future[None] = loop.create_future()
        self.closed: list[asyncio.Future[None]] = []

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        process = cast(asyncio.SubprocessTransport, transport)
        loop = asyncio.get_running_loop()
        self._closed_by_fd = {fd: loop.create_future() for fd in (1, 2) if process.get_pipe_transport(fd) is not None}
        self.closed = list(self._closed_by_fd.values())
        self.process = Process(process, self)
        self._on_start(self.process)

    def pipe_data_received(self, fd: int, data: bytes | str) -> None:
        self._listeners[fd](cast(bytes, data))

    def pipe_connection_lost(self, fd: int, exc: Exception | None) -> None:
        _set_done(self._closed_by_fd.get(fd))

    def process_exited(self) -> None:
        _set_done(self.exited)


class _Terminal(asyncio.Protocol):
    """Passes on the output that arrives through a pseudo terminal."""

    def __init__(self, listener: Listener) -> None:
        self._listener = listener
        self.closed: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def data_received(self, data: bytes) -> None:
        self._listener(data)

    def connection_lost(self, exc: Exception | None) -> None:
        _set_done(self.closed)


class Process:
    """A running process. It shares our process group, so Ctrl+C in the terminal reaches it as well."""

    def __init__(self, transport: asyncio.SubprocessTransport, pipes: _Pipes) -> None:
        self._transport = transport
        self._pipes = pipes
        self._outputs = list(pipes.closed)
        self._terminals: list[asyncio.BaseTransport] = []
        self.pid = transport.get_pid()

    async def read_terminal(self, fd: int, listener: Listener) -> None:
        """Also read from a pseudo terminal's master, and close it with the process."""
        transport, terminal = await asyncio.get_running_loop().connect_read_pipe(
            lambda: _Terminal(listener), os.fdopen(fd, "rb", 0)
        )
        self._terminals.append(transport)
        self._outputs.append(terminal.closed)

    @property
    def returncode(self) -> int | None:
        return self._transport.get_returncode()

    def send(self, number: signal.Signals) -> None:
        """Send a signal. Raises ProcessLookupError if the process has ended."""
        self._transport.send_signal(number)

    async def wait(self) -> int:
        """Wait until the process has ended and its output is read. Return its return code (-N: killed by signal N)."""
        await self._pipes.exited
        if self._outputs:
            await asyncio.wait(self._outputs, timeout=OUTPUT_AFTER_EXIT_S)
        returncode = self._transport.get_returncode()
        assert returncode is not None
        return returncode

    def close(self) -> None:
        """Stop reading its output."""
        for transport in (self._transport, *self._terminals):
            transport.close()


async def start(
    cmd: Sequence[str],
    *,
    cwd: str | None,
    env: Mapping[str, str],
    shell: bool,
    emulate_tty: bool,
    on_start: Callable[[Process], None],
    on_stdout: Listener,
    on_stderr: Listener,
) -> Process:
    """Start a process. `on_start` is called before any output arrives. Raises OSError.

    With `emulate_tty`, the output goes through pseudo terminals.
    """
    listeners = (on_stdout, on_stderr)
    with contextlib.ExitStack() as masters, contextlib.ExitStack() as slaves:
        terminals: list[int] = []
        options: dict[str, Any] = {"cwd": cwd, "env": dict(env)}
        if emulate_tty:
            for name in ("stdout", "stderr"):
                master, options[name] = pty.openpty()
                masters.callback(os.close, master)
                slaves.callback(os.close, options[name])
                terminals.append(master)
        loop = asyncio.get_running_loop()

        def pipes() -> _Pipes:
            return _Pipes(on_start, on_stdout, on_stderr)

        if shell:
            _, protocol = await loop.subprocess_shell(pipes, " ".join(cmd), **options)
        else:
            _, protocol = await loop.subprocess_exec(pipes, *cmd, **options)
        masters.pop_all()  # from here on, the process owns them
    for fd, listener in zip(terminals, listeners, strict=False):
        await protocol.process.read_terminal(fd, listener)
    return protocol.process


def _set_done(future: asyncio.Future[None] | None) -> None:
    if future is not None and not future.done():
        future.set_result(None)
