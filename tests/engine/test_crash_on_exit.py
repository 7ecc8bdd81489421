"""A crash on Ctrl+C is seen on further starts: it fails whoever crashes each time, not whom rclpy let crash once."""

from __future__ import annotations

import asyncio
import importlib
from pathlib import Path
from typing import Any

import pytest

from tests.engine.made import Scene
from tutor.content import load_course
from tutor.judge.ending import judge
from tutor.judge.submission import Submission
from tutor.ros.environment import RosEnvironment
from tutor.workspace import solution

# After all is shut down, as a crash in rclpy's C++ code may come. {} holds which of the ends are such.
CRASHES = """
import os, pathlib, signal
ends = pathlib.Path(__file__).with_name("ends")
with ends.open("a") as file:
    file.write(".")
if len(ends.read_text()) in {}:
    os.kill(os.getpid(), signal.SIGSEGV)
"""
SCENARIOS = [
    ("i1.1", "survey"),
    ("i1.2", "steady"),
    ("i1.3", "survey"),
    ("i2.1", "survey"),
    ("i2.3", "quiet"),
    ("i2.3", "interrupted"),
]


async def ends(ros: RosEnvironment, folder: Path, exercise: str, scenario: str, crashes: tuple[int, ...]) -> Any:
    """The facts of a scenario of this exercise, done to its solution, the given ends of which (from 1) are crashes."""
    from tutor.engine.bench import LiveBench

    files = {}
    for name, path in solution(load_course().find(exercise)).files.items():
        files[name] = folder / name
        files[name].write_text(path.read_text() + CRASHES.format(crashes))
    bench = LiveBench(Submission(exercise, files), ros, _nothing_shared, lambda fraction, text: None)
    scenarios = importlib.import_module(f"checks.{exercise.replace('.', '_')}.scenarios")
    return await getattr(scenarios, scenario)(bench)


async def _nothing_shared(scenario: Any) -> Any:
    raise AssertionError("no other scenario")


async def test_one_crash_is_forgiven(ros: RosEnvironment, scene: Scene) -> None:
    async def one(number: int, exercise: str, scenario: str) -> None:
        folder = scene.folder / str(number)
        folder.mkdir()
        seen = await ends(ros, folder, exercise, scenario, (1,))
        verdict = judge(seen.trace, seen.ending)
        assert verdict.passed, (exercise, scenario, verdict)
        assert (folder / "ends").read_text() == "...", (exercise, scenario)  # the crash, and two more

    async with asyncio.TaskGroup() as together:
        for number, (exercise, scenario) in enumerate(SCENARIOS):
            together.create_task(one(number, exercise, scenario))


@pytest.mark.parametrize(("crashes", "starts"), [((1, 2), 2), ((1, 3), 3)])
async def test_a_second_crash_is_not(scene: Scene, crashes: tuple[int, ...], starts: int) -> None:
    seen = await ends(scene.ros, scene.folder, "i1.3", "survey", crashes)
    verdict = judge(seen.trace, seen.ending)
    assert verdict.cause is not None
    assert "signal 11, at calculator_server.py, line" in str(verdict.cause), verdict
    assert len((scene.folder / "ends").read_text()) == starts


async def test_who_does_not_crash_is_started_once(scene: Scene) -> None:
    seen = await ends(scene.ros, scene.folder, "i1.3", "survey", ())
    assert judge(seen.trace, seen.ending).passed
    assert (scene.folder / "ends").read_text() == "."
