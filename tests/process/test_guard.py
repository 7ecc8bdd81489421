"""A learner's program run by an ordinary user can neither read our processes nor write to their files."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from tests import unprivileged

INTRUDER = """
import ctypes, json, os
libc = ctypes.CDLL(None, use_errno=True)
def stat(pid):
    return open(f"/proc/{pid}/stat").read().rpartition(")")[2].split()
supervisor = os.getppid()
done = []
for pid in (supervisor, int(stat(supervisor)[1])):
    for file in ("fd/1", "fd/0", "environ", "mem"):
        try:
            os.open(f"/proc/{pid}/{file}", os.O_WRONLY if file.startswith("fd") else os.O_RDONLY)
        except PermissionError:
            continue
        done.append(f"{pid}: {file}")
    if libc.ptrace(0x4206, pid, None, None) == 0:  # PTRACE_SEIZE
        done.append(f"{pid}: ptrace")
print(json.dumps([done, libc.prctl(3)]))  # PR_GET_DUMPABLE: of itself
"""
START_INTRUDER = f"""
import asyncio, sys
from pathlib import Path
from tutor.process import LearnerProcess
async def main():
    argv = [sys.executable, "-I", "-S", "-c", {INTRUDER!r}]
    async with await LearnerProcess.start(argv, env={{}}, cwd=Path("/")) as learner:
        await learner.wait(20)
        print(*(line.text for line in learner.output))
asyncio.run(main())
"""


def test_our_processes_cannot_be_opened_or_traced() -> None:
    prefix = unprivileged.prefix()
    if prefix is None:
        pytest.skip("no program can be run here as an ordinary user")
    ran = subprocess.run(
        [*prefix, sys.executable, "-I", "-c", START_INTRUDER],
        env={**os.environ, "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ran.stderr == ""
    done, dumpable = json.loads(ran.stdout)
    assert done == []
    assert dumpable == 1
