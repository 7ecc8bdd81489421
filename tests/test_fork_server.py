"""What a fork server starts behaves like a new process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.fork_server import fork_server

PROGRAM = """
import os, sys
print(__name__, sys.modules["__main__"].__dict__ is globals(), sys.argv, os.environ, os.getcwd())
print(os.getpgid(0) == os.getpid(), os.listdir("/proc/self/fd"))
print(sys.stdout.isatty(), sys.stdout.seekable(), sys.stdout.line_buffering, sys.stdout.encoding, sys.path)
print(sys.stdin.read(), file=sys.stderr)
sys.exit(int(sys.argv[1]))
"""
"""Prints what a program may know about how it was started."""


def run(start: Callable[[list[str], int, int], Callable[[float], int]], words: list[str]) -> tuple[str, int]:
    """Run a program that reads "input". Return what it prints, and its exit code."""
    (read_input, write_input), (read_output, output) = os.pipe(), os.pipe()
    wait = start(words, read_input, output)
    os.close(read_input)
    os.close(output)
    with os.fdopen(write_input, "w") as to:
        to.write("input")
    with os.fdopen(read_output) as shown:
        return shown.read(), wait(60)


@pytest.mark.parametrize("form", ["code", "module", "script"])
def test_a_forked_program_sees_what_a_new_process_sees(tmp_path: Path, form: str) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    words = {"code": ["-c", PROGRAM], "module": ["-m", "program"], "script": [str(tmp_path / "program.py")]}[form]
    env = {**os.environ, "LANG": "C.UTF-8", "PYTHONPATH": str(tmp_path)}

    def start_new(words: list[str], stdin: int, output: int) -> Callable[[float], int]:
        command = [sys.executable, "-P", *words]
        process = subprocess.Popen(
            command, env={**env, "A": "b"}, cwd=tmp_path, stdin=stdin, stdout=output, stderr=output, process_group=0
        )
        return process.wait

    with fork_server("import json", env) as server:

        def fork(words: list[str], stdin: int, output: int) -> Callable[[float], int]:
            return server.start(
                words, env={**env, "A": "b"}, cwd=tmp_path, stdin=stdin, stdout=output, stderr=output
            ).wait

        for code in ("0", "7"):
            shown, forked = run(start_new, [*words, code]), run(fork, [*words, code])
            assert forked == shown
            assert shown[1] == int(code)


def test_the_signal_that_ends_a_forked_program_is_reported(tmp_path: Path) -> None:
    read, write = os.pipe()
    with os.fdopen(read), os.fdopen(write), fork_server("", os.environ) as server:
        program = server.start(
            ["-c", "import time; time.sleep(60)"], env=os.environ, cwd=tmp_path, stdin=read, stdout=write, stderr=write
        )
        assert program.poll() is None
        os.kill(program.pid, signal.SIGTERM)
        assert program.wait(60) == program.poll() == -signal.SIGTERM


def test_a_server_that_cannot_fork_safely_says_so() -> None:
    threads = "import threading, time; threading.Thread(target=time.sleep, args=[60], daemon=True).start()"
    with pytest.raises(AssertionError, match="other threads would be missing"), fork_server(threads, os.environ):
        pass
