"""Killing one process of a check with `kill -9` is never the learner's fault and leaves nothing behind."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tutor.process.process_table import descendants, processes

ROOT = Path(__file__).parents[2]
LIMIT_S = 60.0
GONE_S = 10.0


def command_line(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode()
    except OSError:  # it has ended
        return ""


def wait_until(condition: Callable[[], bool], limit_s: float, what: str) -> None:
    deadline = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < deadline, f"waited in vain for {what}"
        time.sleep(0.05)  # most conditions read all of /proc


@pytest.mark.parametrize(("victim", "code"), [("-m tutor", -9), ("supervisor.py", 3), ("temperature_publisher.py", 0)])
def test_one_process_of_a_clones_check_is_killed(tmp_path: Path, victim: str, code: int) -> None:
    file = tmp_path / "temperature_publisher.py"
    if code == 0:  # the node is started again, and passes
        shutil.copy(ROOT / "lessons" / "i1_1" / "solution" / file.name, file)
    else:
        file.write_text("import time\ntime.sleep(1000)\n")
    process = subprocess.Popen(
        [str(ROOT / "ros-tutor"), "check", "i1.1", str(tmp_path), "--criterion", "publishes"],
        env={**os.environ, "TMPDIR": str(tmp_path)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    running: dict[int, str] = {}

    def is_up() -> bool:
        running.update({pid: command_line(pid) for pid in (process.pid, *(p.pid for p in descendants(process.pid)))})
        return any(str(file) in line and "supervisor.py" not in line for line in running.values())

    try:
        wait_until(is_up, LIMIT_S, "the learner's node")
        os.kill(next(pid for pid, line in running.items() if victim in line), signal.SIGKILL)
        assert process.wait(LIMIT_S) == code
        wait_until(
            lambda: not any(p.alive and p.pid in running for p in processes().values()), GONE_S, f"{running} to end"
        )
    finally:
        process.kill()
        process.wait()
