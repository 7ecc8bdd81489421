"""Checks on one machine take turns."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.ros.own_network import OWN_NETWORK, needs_own_network

# Ten checks in a network namespace without other checks, each counting how many run at once.
TEN = """
import asyncio, os
from tutor.engine.scheduling import turn

async def main():
    under_way, most = 0, 0
    async def check():
        nonlocal under_way, most
        async with turn():
            under_way += 1
            most = max(most, under_way)
            await asyncio.sleep(0.05)
            under_way -= 1
    await asyncio.gather(*(check() for _ in range(10)))
    assert most == min(10, 2 * len(os.sched_getaffinity(0))), most
    async with asyncio.timeout(20):
        async with asyncio.TaskGroup() as group:
            for _ in range(10):
                group.create_task(late())

async def late():
    async with turn(limit_s=0.3):
        await asyncio.sleep(1)  # longer than the others wait

asyncio.run(main())
"""


@needs_own_network
def test_two_checks_per_core_run_at_once_and_none_waits_forever() -> None:
    subprocess.run(
        [sys.executable, "-c", OWN_NETWORK + TEN], check=True, timeout=60, env={**os.environ, "PYTHONPATH": os.getcwd()}
    )


# This process takes all turns; the program under test is appended.
TAKEN = """
import fcntl, json, os, pty, signal, socket, struct, subprocess, sys, time
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
    fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh", b"lo", 1))  # the loopback interface is up

held = []
for number in range(2 * len(os.sched_getaffinity(0))):
    held.append(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
    held[-1].bind(f"\\0ros-tutor-check-{number}")
"""

ON_A_TERMINAL = """
out, out_end = pty.openpty()
check = subprocess.Popen(
    [sys.executable, "-m", "tutor", "check", "i1.3", sys.argv[2], "--criterion", "services"],
    stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=out_end, env={**os.environ, "TERM": "xterm"},
)
os.close(out_end)
said = b""
while b"waiting for other checks on this machine" not in said:
    said += os.read(out, 65536)
if sys.argv[1] == "press":
    pressed = time.monotonic()
    check.send_signal(signal.SIGINT)
else:
    for each in held:
        each.close()
try:
    while True:
        said += os.read(out, 65536)
except OSError:  # it has ended
    pass
code = check.wait()
if sys.argv[1] == "press":
    assert code == 130, (code, said)
    assert time.monotonic() - pressed < 10, said
else:
    assert code == 1, (code, said)  # judged
"""

IN_THE_APP = """
engine = subprocess.Popen(
    [sys.executable, "-m", "tutor.engine", "i1.3", sys.argv[2], "--criterion", "services"],
    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True,
)
assert json.loads(engine.stdout.readline()) == {"event": "CheckStarted", "exercise": "i1.3", "criteria": ["services"]}
said = json.loads(engine.stdout.readline())
assert (said["event"], said["doing"]) == ("Progress", "waiting for other checks on this machine"), said
if sys.argv[1] == "press":
    engine.send_signal(signal.SIGINT)
else:
    for each in held:
        each.close()
rest = [json.loads(line) for line in engine.stdout]
assert not any(event["event"] == "CheckStarted" for event in rest)
if sys.argv[1] == "press":
    assert (engine.wait(), rest) == (130, [])
else:
    assert (engine.wait(), rest[-1]["event"]) == (0, "CheckFinished")
"""


@needs_own_network
@pytest.mark.parametrize("program", [ON_A_TERMINAL, IN_THE_APP], ids=["terminal", "app"])
@pytest.mark.parametrize("end", ["press", "free"])
def test_a_waiting_check_says_so_and_ends_on_ctrl_c(tmp_path: Path, program: str, end: str) -> None:
    (tmp_path / "calculator_server.py").write_text("raise SystemExit(1)")
    root = Path(__file__).parents[2]
    ran = subprocess.run(
        [sys.executable, "-c", OWN_NETWORK + TAKEN + program, end, tmp_path],
        cwd=root, env={**os.environ, "PYTHONPATH": str(root)}, capture_output=True, text=True, timeout=100, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
