"""Python programs forked from a process that has already imported what they need: imports are most of their CPU time.

Each is a process of its own, with its own arguments, environment, folder and streams, and runs what `python` would run;
it only finds some modules imported already. Not for tests of how a program starts.
"""

from __future__ import annotations

import gc
import json
import os
import runpy
import select
import selectors
import socket
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import ModuleType

_MAX_REQUEST_BYTES = 150_000
_READ_AT_START = ("PYTHON", "LD_")
"""The beginnings of variables that only count when Python starts: they must be the same for a server's programs."""


class Forked:
    """A program that a server has forked."""

    def __init__(self, report: int) -> None:
        self._report = os.fdopen(report, "rb", buffering=0)
        text = self._report.read(8)
        assert text, "the fork server has ended"
        self.pid = int(text)
        self.returncode: int | None = None

    def poll(self) -> int | None:
        """Return the exit code, or minus the number of the signal that ended the program; None while it is running."""
        return self._read_code(0)

    def wait(self, timeout: float) -> int:
        """Wait for the program to end, and return what `poll` then returns. Raises TimeoutExpired."""
        if (code := self._read_code(timeout)) is None:
            raise subprocess.TimeoutExpired(f"process {self.pid}", timeout)
        return code

    def _read_code(self, timeout: float) -> int | None:
        if self.returncode is None and select.select([self._report], [], [], timeout)[0]:
            with self._report:
                text = self._report.read(8)
            assert text, "the fork server has ended"
            self.returncode = int(text)
        return self.returncode


class ForkServer:
    """A running server."""

    def __init__(self, control: socket.socket, env: Mapping[str, str]) -> None:
        self._control = control
        self._env = env

    def start(
        self,
        words: Sequence[str],
        *,
        env: Mapping[str, str],
        cwd: Path,
        stdin: int,
        stdout: int,
        stderr: int,
        new_session: bool = False,
    ) -> Forked:
        """Run what `python -P WORDS...` would, in a process group or session of its own. The streams are pipes."""
        assert _read_at_start(env) == _read_at_start(self._env), "the server was started with other variables"
        request = json.dumps({"words": words, "env": dict(env), "cwd": str(cwd), "new_session": new_session}).encode()
        assert len(request) < _MAX_REQUEST_BYTES
        report, theirs = os.pipe()
        try:
            socket.send_fds(self._control, [request], [stdin, stdout, stderr, theirs])
        finally:
            os.close(theirs)
        return Forked(report)


@contextmanager
def fork_server(preload: str, env: Mapping[str, str]) -> Iterator[ForkServer]:
    """Run a server during the block, started in `env`. `preload`: the code that imports the modules."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours:
        with theirs:
            server = subprocess.Popen(
                [sys.executable, "-P", __file__, str(theirs.fileno()), preload],
                env=dict(env),
                stdin=subprocess.PIPE,  # Python treats streams differently according to what they are at its start
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                pass_fds=[theirs.fileno()],
                process_group=0,
            )
        try:
            yield ForkServer(ours, env)
        finally:
            ours.close()
            _, errors = server.communicate(timeout=60)
            assert (server.returncode, errors) == (0, ""), errors


def _read_at_start(env: Mapping[str, str]) -> dict[str, str]:
    return {name: value for name, value in env.items() if value and name.startswith(_READ_AT_START)}


# --- in the server


def _serve(control: socket.socket) -> list[str]:
    """Fork a program for each request, until the tests hang up. Returns in the programs only, with their words."""
    selector = selectors.DefaultSelector()
    selector.register(control, selectors.EVENT_READ)
    while True:
        for key, _ in selector.select():
            if key.data is not None:
                selector.unregister(key.fd)
                os.close(key.fd)
                _report_end(*key.data)
                continue
            message, descriptors, _, _ = socket.recv_fds(control, _MAX_REQUEST_BYTES, 4)
            if not message:
                sys.exit()
            *streams, report = descriptors
            if (pid := os.fork()) == 0:
                control.detach()
                selector.close()
                return _become_program(json.loads(message), streams)
            for each in streams:
                os.close(each)
            os.write(report, b"%8d" % pid)
            selector.register(os.pidfd_open(pid), selectors.EVENT_READ, (pid, report))


def _report_end(pid: int, report: int) -> None:
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    with suppress(BrokenPipeError):
        os.write(report, b"%8d" % code)
    os.close(report)


def _become_program(request: dict[str, object], streams: list[int]) -> list[str]:
    words, env, cwd, new_session = (request[key] for key in ("words", "env", "cwd", "new_session"))
    assert isinstance(words, list)
    assert isinstance(env, dict)
    if new_session:
        os.setsid()
    else:
        os.setpgid(0, 0)
    for number, descriptor in enumerate(streams):
        os.dup2(descriptor, number)
    os.closerange(3, 2**16)
    os.environ.clear()
    os.environ.update(env)
    os.chdir(str(cwd))
    return words


def _run(words: list[str]) -> None:
    """Run what `python WORDS...` would run."""
    match words:
        case ["-m", module, *arguments]:
            sys.argv = [module, *arguments]
            runpy.run_module(module, run_name="__main__", alter_sys=True)
        case ["-c", code, *arguments]:
            sys.argv = ["-c", *arguments]
            sys.modules["__main__"] = main = ModuleType("__main__")
            exec(code, main.__dict__)
        case [script, *_]:
            sys.argv = words
            runpy.run_path(script, run_name="__main__")


if __name__ == "__main__":
    exec(sys.argv[2], {})
    assert len(os.listdir("/proc/self/task")) == 1, "other threads would be missing in the programs"
    gc.collect()
    gc.freeze()
    _run(_serve(socket.socket(fileno=int(sys.argv[1]))))
