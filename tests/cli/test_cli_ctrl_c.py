"""Ctrl+C at whatever moment of a start: the end is 130, and nothing is said."""

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
"""Both are 130 for a shell: sh itself is ended by the signal."""

needs_env = pytest.mark.skipif(
    subprocess.run(["env", "--block-signal=INT", "true"], capture_output=True).returncode != 0,
    reason="this env blocks no signals",
)
Seen = Callable[[int], bool]


@pytest.fixture
def installed(tmp_path: Path) -> str:
    """`ros-tutor` as an installer places it: beside its Python."""
    (tmp_path / "bin").mkdir()
    python = tmp_path / "bin" / "python"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    return shutil.copy(str(ROOT / "packaging" / "ros-tutor"), str(tmp_path / "bin"))


def pressed(argv: list[str], is_now: Seen) -> tuple[int, str]:
    """How a program ends, and what it says on stderr, that gets Ctrl+C as soon as this is seen of its process."""
    env = {name: value for name, value in os.environ.items() if name != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    pipe = subprocess.PIPE
    program = subprocess.Popen(argv, env=env, stdout=subprocess.DEVNULL, stderr=pipe, text=True, process_group=0)
    deadline = time.monotonic() + LIMIT_S
    while program.poll() is None and not is_now(program.pid) and time.monotonic() < deadline:
        time.sleep(0.0005)  # other tests run beside it
    if program.poll() is None:
        os.killpg(program.pid, signal.SIGINT)
    said = program.communicate(timeout=LIMIT_S)[1]
    return program.returncode, said


def after(seconds: float) -> Seen:
    at = time.monotonic() + seconds
    return lambda _: time.monotonic() >= at


def _read(pid: int, name: str) -> bytes:
    try:
        return Path(f"/proc/{pid}/{name}").read_bytes()
    except OSError:
        return b""


def is_python(pid: int) -> bool:
    first, *words = _read(pid, "cmdline").split(b"\0")
    return Path(first.decode()).name.startswith("python") and b"tutor" in words


def is_python_with_libraries(pid: int) -> bool:
    """It has been started a second time: the wheels of ROS restart the interpreter."""
    return is_python(pid) and b"_ROS_WHEELS_BOOTSTRAP_COMPLETE=" in _read(pid, "environ")


@needs_env
@pytest.mark.parametrize("is_now", [is_python, is_python_with_libraries])
def test_while_python_itself_starts(installed: str, is_now: Seen) -> None:
    assert pressed([installed, "list"], is_now) == (130, "")
    assert pressed([str(ROOT / "ros-tutor"), "list"], is_now) == (130, "")


CHECK = ("check", "i1.3", str(ROOT / "lessons" / "i1_3" / "solution"), "--criterion", "services")


@needs_env
@pytest.mark.parametrize(
    ("words", "end", "until_s"),
    [(("list",), 0, 0.2), (("check", "i9.9", "."), 2, 0.2), (CHECK, 0, 1.2), (("ros2", "topic", "--help"), 0, 0.2)],
    ids=["list", "refused", "check", "ros2"],
)
def test_at_any_time(installed: str, words: tuple[str, ...], end: int, until_s: float) -> None:
    ordinary = pressed([installed, *words], lambda _: False)[1]
    for step in range(20):
        code, said = pressed([installed, *words], after(step * until_s / 20))
        assert code in (*INTERRUPTED, end, 2 if words[0] == "ros2" else end), (step, code, said)  # 2: as ros2cli ends
        assert all(line.startswith("ros-tutor: ") for line in said.splitlines()), (step, said)
        assert said in ("", ordinary) or "nothing is left running" in said, (step, said)


@needs_env
def test_while_a_clone_is_looked_after() -> None:
    for step in range(0, 1000, 100):
        code, said = pressed([str(ROOT / "ros-tutor"), "list"], after(step / 1000))
        assert code in (*INTERRUPTED, 0), (step, code, said)
        assert said == "" or code == 0, (step, said)


@pytest.mark.parametrize("cause", [KeyboardInterrupt, ValueError])
def test_where_a_librarys_cleanup_fails_because_of_it(
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


PRESSES_IN_A_DESTRUCTOR = """
import os, runpy, signal, sys

class Press:
    def find_spec(self, name, *_):
        if name == "tutor.cli.parser":
            Dying()

class Dying:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Press())
runpy.run_module("tutor", run_name="__main__")
"""


def test_where_python_can_only_print_it() -> None:
    ended = subprocess.run(
        [sys.executable, "-c", PRESSES_IN_A_DESTRUCTOR], capture_output=True, text=True, timeout=LIMIT_S, check=False
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "", "")
