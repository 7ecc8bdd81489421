"""The log files of nodes that the app runs do not fill the disk."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path

import pytest

from tutor import private_folders
from tutor.process import log_folder
from tutor.session.node import Node
from tutor.session.node_command import NodeCommand

LOGS = """
import os, pathlib, time
log = pathlib.Path(os.environ["ROS_LOG_DIR"]) / "node.log"
log.write_bytes(b"x" * 300_000)
end = time.monotonic() + 20
while log.stat().st_size and time.monotonic() < end:
    time.sleep(0.02)
print("emptied" if not log.stat().st_size else "as it was", flush=True)
"""


@pytest.mark.parametrize("ours", [True, False])
async def test_log_files_are_limited_only_in_our_own_folder(
    ours: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(private_folders, "base", lambda: tmp_path / "ours")
    monkeypatch.setattr(log_folder, "keep_small_until_cancelled", _limit_to_150_kb)
    logs = tmp_path / ("ours" if ours else "theirs") / "log"
    logs.mkdir(parents=True)
    program = LOGS if ours else LOGS.replace("+ 20", "+ 1")
    env = {"ROS_LOG_DIR": str(logs), "PYTHONUNBUFFERED": "1"}
    node = Node(NodeCommand("node.py", (sys.executable, "-c", program), env, tmp_path), lambda state: None)
    await asyncio.wait_for(node.run(), 40)
    assert [line.text for line in node.state.lines] == ["emptied" if ours else "as it was"]


_keep_small_until_cancelled = log_folder.keep_small_until_cancelled


async def _limit_to_150_kb(path: Path) -> None:
    await _keep_small_until_cancelled(path, max_bytes=150_000)
