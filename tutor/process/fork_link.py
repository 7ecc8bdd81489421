"""Our end of a fork server: starts it, and has it fork supervisors."""

from __future__ import annotations

import asyncio
import contextlib
import os
import select
import signal
import socket
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

PROGRAM = Path(__file__).with_name("fork_server.py")
"""The server, whose frames are the outermost ones of what it has forked."""

_PADDING = "-" * 4096
"""Room for the command lines of what is forked, and for what their environments have more than the server's."""

_FORK_LIMIT_S = 10.0
"""How long a fork may take, including the start of the server. After that, the server is given up."""

_END_LIMIT_S = 5.0


class ForkedSupervisor:
    """A supervisor that is not our child. Like `subprocess.Popen`, as far as `SupervisorLink` needs it."""

    def __init__(self, pid: int, pidfd: int) -> None:
        self.pid = pid
        self._pidfd: int | None = pidfd

    def poll(self) -> int | None:
        """Return None while it is running, else 0: its exit code is known to its parent only."""
        if self._pidfd is not None and select.select([self._pidfd], [], [], 0)[0]:
            os.close(self._pidfd)
            self._pidfd = None
        return 0 if self._pidfd is None else None

    def kill(self) -> None:
        """Send SIGKILL, unless it has ended."""
        if self.poll() is None and self._pidfd is not None:
            with contextlib.suppress(ProcessLookupError):
                signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)


class ForkServerLink:
    """A process that has imported modules; see `tutor.process.fork_server`. A context manager that ends it."""

    def __init__(
        self, python: Path, env: Mapping[str, str], modules: Iterable[str], wrapper: Sequence[str] = ()
    ) -> None:
        """Start it with the interpreter and the environment of the programs, without waiting for its imports.

        `wrapper`: a command prefix that runs it in a PID namespace of its own, and with it all that it forks. Raises
        OSError if it cannot be started.
        """
        self._wrapped = bool(wrapper)
        self._control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            try:
                self._process = subprocess.Popen(
                    [*wrapper, str(python), str(PROGRAM), str(theirs.fileno()), ",".join(modules), _PADDING],
                    # Python's streams depend on what they are when it starts: use the same kinds as the programs.
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    pass_fds=(theirs.fileno(),),
                    cwd="/",
                    env={**env, "PADDING": _PADDING},
                    process_group=0,  # no Ctrl+C from our terminal
                )
            except OSError:
                self._control.close()
                raise

    def __enter__(self) -> ForkServerLink:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    async def fork(self, streams: tuple[int, int, int]) -> tuple[ForkedSupervisor, socket.socket] | None:
        """Fork a supervisor with these stdin, stdout and stderr; return it and our end of its socket.

        Returns None if the server has ended or does not answer: use another way then.
        """
        ours, theirs = socket.socketpair()
        try:
            with theirs:
                socket.send_fds(self._control, [b"fork"], [theirs.fileno(), *streams])
            answered = asyncio.get_running_loop().create_future()
            asyncio.get_running_loop().add_reader(ours, _resolve, answered)
            try:
                await asyncio.wait_for(answered, _FORK_LIMIT_S)
            finally:
                asyncio.get_running_loop().remove_reader(ours)
            answer, pidfds, _, _ = socket.recv_fds(ours, 16, 1)
            if not answer:
                raise ConnectionResetError("the fork server has ended")
            supervisor = ForkedSupervisor(_pid_of(pidfds[0]), pidfds[0])
        except OSError:  # a TimeoutError is one, too
            self._give_up()
            ours.close()
            return None
        except BaseException:
            ours.close()
            raise
        ours.setblocking(False)
        return supervisor, ours

    def _give_up(self) -> None:
        if self._wrapped:  # what it has forked would die with it
            self._control.close()
        else:
            self._process.kill()
            self.close()

    def kill(self) -> None:
        """Kill the server, and with it all that it has forked if it has a PID namespace of its own."""
        self._process.kill()

    def close(self) -> None:
        """End the server. What it has forked goes on, but without a parent. Idempotent."""
        self._control.close()
        try:
            self._process.communicate(timeout=_END_LIMIT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.communicate()


def _pid_of(pidfd: int) -> int:
    """Return the pid that a process has here: in a PID namespace of its own, it knows another one.

    Raises ProcessLookupError if it has ended.
    """
    with open(f"/proc/self/fdinfo/{pidfd}") as info:
        pid = next((int(line.split()[1]) for line in info if line.startswith("Pid:")), 0)
    if pid < 1:
        raise ProcessLookupError("it has ended")
    return pid


def _resolve(future: asyncio.Future[None]) -> None:
    if not future.done():
        future.set_result(None)
