"""Starts supervisors: forked by a server, else as programs of their own; within a wrapper, if there is one."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor.process.fork_link import ForkedSupervisor, ForkServerLink

_SUPERVISOR = Path(__file__).with_name("supervisor.py")

type SupervisorProcess = subprocess.Popen[bytes] | ForkedSupervisor


@dataclass(frozen=True, slots=True)
class Spawner:
    """Starts supervisors, each of which starts one program.

    `fork_server`: where they are forked, as long as it answers. `wrapper`: a command prefix that runs a supervisor in a
    PID namespace of its own, as a child of the namespace's init process. The kernel kills the whole namespace when that
    one exits, and that one dies with us. The fork server then has such a namespace too, and what it forks shares it.
    """

    fork_server: ForkServerLink | None = None
    wrapper: Sequence[str] = ()

    async def spawn(self, streams: tuple[int, int, int]) -> tuple[SupervisorProcess, socket.socket]:
        """Start a supervisor with these stdin, stdout and stderr; return it, and our end of its socket.

        Raises OSError if it cannot be started.
        """
        forked = await self.fork_server.fork(streams) if self.fork_server is not None else None
        return forked or _start(streams, self.wrapper)

    def kill_namespace(self, supervisor: SupervisorProcess) -> None:
        """Kill what shares a PID namespace with a supervisor that was forked and has ended, unless that is ours."""
        if self.wrapper and self.fork_server is not None and isinstance(supervisor, ForkedSupervisor):
            self.fork_server.kill()


DIRECTLY = Spawner()
"""Starts them without a fork server, and without isolation."""


def _start(streams: tuple[int, int, int], wrapper: Sequence[str]) -> tuple[subprocess.Popen[bytes], socket.socket]:
    stdin, stdout, stderr = streams
    ours, theirs = socket.socketpair()
    owner = 1 if wrapper else os.getpid()
    with theirs:
        try:
            supervisor = subprocess.Popen(
                [*wrapper, sys.executable, "-I", "-S", str(_SUPERVISOR), str(theirs.fileno()), str(owner)],
                stdin=stdin,
                stdout=stdout,
                stderr=stderr,
                pass_fds=(theirs.fileno(),),
                cwd="/",
                # Otherwise the ROS wheels would make the interpreter start twice.
                env={**_environment(wrapped=bool(wrapper)), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"},
                start_new_session=True,
            )
        except OSError:
            ours.close()
            raise
    return supervisor, ours


def _environment(*, wrapped: bool) -> dict[str, str]:
    """Return our environment variables; of a wrapper, which its processes can read, only those that it needs."""
    names = ("LANG", "LD_LIBRARY_PATH", "PATH") if wrapped else os.environ
    return {name: os.environ[name] for name in names if name in os.environ}
