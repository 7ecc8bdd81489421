"""When a check is killed together with its supervisor, orphans of the learner's program are reparented to the app."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from tests.waiting import wait_for
from tutor.process.process_table import processes
from tutor.session.engine_process import EngineChild

DAEMONIZES_AND_KILLS_ITSELF = """
import os, signal, sys, time
if os.fork() == 0:
    os.setsid()
    if os.fork():
        os._exit(0)
    os.closerange(0, 100)
    with open("new", "w") as file:
        file.write(str(os.getpid()))
    os.rename("new", "daemon")
    time.sleep(1000)
while not os.path.exists("daemon"):
    time.sleep(0.001)
os.kill(os.getpid(), signal.SIGKILL)
"""


async def test_a_daemon_does_not_outlive_a_killed_check(tmp_path: Path) -> None:
    child = await EngineChild.start([sys.executable, "-I", "-S", "-c", DAEMONIZES_AND_KILLS_ITSELF], tmp_path)
    assert await wait_for((tmp_path / "daemon").exists, 20)
    daemon = int((tmp_path / "daemon").read_text())
    assert await child.ended() == -9
    assert processes()[daemon].parent == os.getpid()
    await child.stop()
    assert daemon not in processes()
