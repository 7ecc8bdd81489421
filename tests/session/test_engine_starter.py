"""The engine that is kept ready: when a check uses it, and that it does not stay longer than it should."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from tests.waiting import wait_for
from tutor.process.process_table import processes
from tutor.session import engine_process
from tutor.session.engine_process import EngineChild, EngineStarter

ENGINE = """
import json, os, sys
arguments = sys.argv[1:]
if arguments == ["--standby"]:
    with open("new", "w") as file:
        file.write(str(os.getpid()))
    os.rename("new", "ready")
    line = sys.stdin.readline()
    if not line:
        sys.exit()
    arguments = json.loads(line)
print(json.dumps(arguments))
"""


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-I", "-S", "-c", ENGINE, *arguments]


@asynccontextmanager
async def ready_engine(engines: EngineStarter, cwd: Path) -> AsyncIterator[int]:
    """Keep an engine ready, and yield its pid; release it at the end, when it must not be running any more."""
    keeping = asyncio.create_task(engines.keep_ready(cwd))
    assert await wait_for((cwd / "ready").exists, 20)
    pid = int((cwd / "ready").read_text())
    try:
        yield pid
    finally:
        engines.release()
        await keeping
    assert not engines.keeps_one
    assert pid not in processes()


async def printed(child: EngineChild) -> list[str]:
    lines = [line async for line in child.lines()]
    assert await child.ended() == 0
    return lines


async def test_a_check_uses_the_engine_that_is_ready_once(tmp_path: Path) -> None:
    engines = EngineStarter(command)
    async with ready_engine(engines, tmp_path) as pid:
        child = await engines.start(["i1.1", "a folder"], tmp_path)
        assert child.pid == pid
        assert await printed(child) == ['["i1.1", "a folder"]']
        another = await engines.start(["i1.2"], tmp_path)
        assert another.pid != pid
        assert await printed(another) == ['["i1.2"]']


async def test_a_check_in_another_folder_does_not_use_it(tmp_path: Path) -> None:
    engines = EngineStarter(command)
    (tmp_path / "other").mkdir()
    async with ready_engine(engines, tmp_path) as pid:
        child = await engines.start(["i1.1"], tmp_path / "other")
        assert child.pid != pid
        assert await printed(child) == ['["i1.1"]']


async def test_a_check_does_not_use_one_that_was_killed(tmp_path: Path) -> None:
    engines = EngineStarter(command)
    async with ready_engine(engines, tmp_path) as pid:
        os.kill(pid, signal.SIGKILL)
        ready = engines._ready
        assert ready is not None
        assert await wait_for(lambda: not ready.running, 20)
        child = await engines.start(["i1.1"], tmp_path)
        assert await printed(child) == ['["i1.1"]']


async def test_only_one_is_kept_and_not_for_ever(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    engines = EngineStarter(command)
    async with ready_engine(engines, tmp_path):
        await engines.keep_ready(tmp_path)  # returns at once
    (tmp_path / "ready").unlink()
    monkeypatch.setattr(engine_process, "KEEP_READY_S", 0.01)
    await engines.keep_ready(tmp_path)
    assert not engines.keeps_one
    pids = [int(path.read_text()) for path in [tmp_path / "ready"] if path.exists()]  # it may have ended before it ran
    assert not [pid for pid in pids if pid in processes()]


async def test_without_one_a_check_starts_all_the_same(tmp_path: Path) -> None:
    def impossible_standby(*arguments: str) -> list[str]:
        return ["/no/such/python"] if arguments == ("--standby",) else command(*arguments)

    engines = EngineStarter(impossible_standby)
    await engines.keep_ready(tmp_path)
    assert not engines.keeps_one
    assert await printed(await engines.start(["i1.1"], tmp_path)) == ['["i1.1"]']
