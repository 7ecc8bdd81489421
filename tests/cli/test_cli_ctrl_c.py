"""Ctrl+C at any moment of a start: the program exits with 130 and prints nothing."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tutor import cli

ROOT = Path(__file__).parents[2]
LIMIT_S = 60.0
INTERRUPTED = (130, -signal.SIGINT)
"""A shell reports both as 130; sh itself is killed by the signal."""

needs_env = pytest.mark.skipif(
    subprocess.run(["env", "--block-signal=INT", "true"], capture_output=True).returncode != 0,
    reason="this env blocks no signals",
)
Condition = Callable[[int], bool]


@pytest.fixture
def installed(tmp_path: Path) -> str:
    """`ros-tutor` where an installer puts it: beside its Python."""
    (tmp_path / "bin").mkdir()
    python = tmp_path / "bin" / "python"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    return shutil.copy(str(ROOT / "packaging" / "ros-tutor"), str(tmp_path / "bin"))


def interrupt_when(argv: list[str], condition: Condition) -> tuple[int, str]:
    """Run a program, and press Ctrl+C once the condition holds for its pid. Returns its exit code and stderr."""
    env = {name: value for name, value in os.environ.items() if name != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    pipe = subprocess.PIPE
    program = subprocess.Popen(argv, env=env, stdout=subprocess.DEVNULL, stderr=pipe, text=True, process_group=0)
    deadline = time.monotonic() + LIMIT_S
    while program.poll() is None and not condition(program.pid) and time.monotonic() < deadline:
        time.sleep(0.0005)  # leave the CPU to tests that run in parallel
    if program.poll() is None:
        os.killpg(program.pid, signal.SIGINT)
    stderr = program.communicate(timeout=LIMIT_S)[1]
    return program.returncode, stderr


def after(seconds: float) -> Condition:
    due = time.monotonic() + seconds
    return lambda _: time.monotonic() >= due


def _read(pid: int, name: str) -> bytes:
    try:
        return Path(f"/proc/{pid}/{name}").read_bytes()
    except OSError:
        return b""


def is_python(pid: int) -> bool:
    first, *words = _read(pid, "cmdline").split(b"\0")
    return Path(first.decode()).name.startswith("python") and b"tutor" in words


def is_restarted_python(pid: int) -> bool:
    """Whether this is the second start: the ROS wheels restart the interpreter."""
    return is_python(pid) and b"_ROS_WHEELS_BOOTSTRAP_COMPLETE=" in _read(pid, "environ")


@needs_env
@pytest.mark.parametrize("condition", [is_python, is_restarted_python])
def test_ctrl_c_while_the_interpreter_starts(installed: str, condition: Condition) -> None:
    assert interrupt_when([installed, "list"], condition) == (130, "")
    assert interrupt_when([str(ROOT / "ros-tutor"), "list"], condition) == (130, "")


CHECK = ("check", "i1.3", str(ROOT / "lessons" / "i1_3" / "solution"), "--criterion", "services")


@needs_env
@pytest.mark.parametrize(
    ("words", "exit_code", "until_s", "steps"),
    [
        (("list",), 0, 0.2, 8),
        (("check", "i9.9", "."), 2, 0.2, 6),
        (CHECK, 0, 1.2, 10),
        (("ros2", "topic", "--help"), 0, 0.2, 8),
    ],
    ids=["list", "refused", "check", "ros2"],
)
def test_ctrl_c_at_any_time(installed: str, words: tuple[str, ...], exit_code: int, until_s: float, steps: int) -> None:
    interrupted_command = 2 if words[0] == "ros2" else exit_code  # 2: the exit code of ros2cli
    usual_stderr = interrupt_when([installed, *words], lambda _: False)[1]
    for step in range(steps):
        at_s = step * until_s / steps
        code, stderr = interrupt_when([installed, *words], after(at_s))
        assert code in (*INTERRUPTED, exit_code, interrupted_command), (at_s, code, stderr)
        assert all(line.startswith("ros-tutor: ") for line in stderr.splitlines()), (at_s, stderr)
        assert stderr in ("", usual_stderr) or "nothing is left running" in stderr, (at_s, stderr)


@needs_env
def test_ctrl_c_while_a_clone_checks_its_environment() -> None:
    for step in range(6):
        at_s = step / 6
        code, stderr = interrupt_when([str(ROOT / "ros-tutor"), "list"], after(at_s))
        assert code in (*INTERRUPTED, 0), (at_s, code, stderr)
        assert stderr == "" or code == 0, (at_s, stderr)


@pytest.mark.parametrize("cause", [KeyboardInterrupt, ValueError])
def test_ctrl_c_that_makes_a_librarys_cleanup_fail(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], cause: type[BaseException]
) -> None:
    def run(_: object) -> int:
        try:
            raise cause
        finally:
            del run.never_set  # type: ignore[attr-defined]

    monkeypatch.setattr(cli, "_run", run)
    by_ctrl_c = cause is KeyboardInterrupt
    assert cli.main([]) == (130 if by_ctrl_c else 3)
    assert (capsys.readouterr().err == "") is by_ctrl_c


INTERRUPTS_IN_A_DESTRUCTOR = """
import os, runpy, signal, sys

class Press:
    def find_spec(self, name, *_):
        if name == "tutor.cli.global_options":
            Dying()

class Dying:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Press())
runpy.run_module("tutor", run_name="__main__")
"""


def test_ctrl_c_where_python_can_only_print_the_exception() -> None:
    result = subprocess.run(
        [sys.executable, "-c", INTERRUPTS_IN_A_DESTRUCTOR], capture_output=True, text=True, timeout=LIMIT_S, check=False
    )
    assert (result.returncode, result.stdout, result.stderr) == (130, "", "")
