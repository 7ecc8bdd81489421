"""A bad end that may be chance is seen on further starts: it fails whom it meets each time, not whom it meets once."""

from __future__ import annotations

import asyncio
import importlib
from pathlib import Path
from typing import Any

import pytest

from tests.engine.made import Scene, nothing_shared
from tutor.content import load_course
from tutor.judge.ending import judge_ending
from tutor.judge.submission import Submission
from tutor.ros.environment import RosEnvironment
from tutor.workspace import solution

# After all is shut down, as a crash in rclpy's C++ code may come: which of the ends are such, and what it then does.
CRASHES = """
import os, pathlib, signal
import rclpy
from rclpy.executors import SingleThreadedExecutor
def spin_on():
    context = rclpy.Context()
    context.init()
    executor = SingleThreadedExecutor(context=context)
    context.shutdown()
    executor.spin_once()
def try_shutdown():
    raise RuntimeError("failed to shutdown: rcl_shutdown already called on the given context")
ends = pathlib.Path(__file__).with_name("ends")
with ends.open("a") as file:
    file.write(".")
if len(ends.read_text()) in {}:
    {}
{}
"""
CRASH = "os.kill(os.getpid(), signal.SIGSEGV)"
SPIN_ON = "spin_on()"
RACE = "try_shutdown()"
# By chance it raises, as `try_shutdown` does above, and what we add to the file would not be reached.
TRIES = "rclpy.try_shutdown()"
TRIES_SAFELY = "with __import__('contextlib').suppress(RuntimeError): rclpy.try_shutdown()"
SCENARIOS = [
    ("i1.1", "plain_start"),
    ("i1.2", "steady"),
    ("i1.3", "call_each_service"),
    ("i2.1", "plain_start"),
    ("i2.3", "run_idle"),
    ("i2.3", "interrupt_during_call"),
]


async def ends(
    ros: RosEnvironment,
    folder: Path,
    exercise: str,
    scenario: str,
    which: tuple[int, ...],
    does: str,
    else_does: str = "",
) -> Any:
    """The facts of a scenario of this exercise, done to its solution, which at these ends (from 1) does this."""
    from tutor.engine.bench import RosBench

    files = {}
    for name, path in solution(load_course().find(exercise)).files.items():
        files[name] = folder / name
        text = path.read_text()
        assert text.count(TRIES) == 1, path
        files[name].write_text(text.replace(TRIES, TRIES_SAFELY) + CRASHES.format(which, does, else_does))
    bench = RosBench(Submission(exercise, files), ros, nothing_shared, lambda fraction, text: None)
    scenarios = importlib.import_module(f"checks.{exercise.replace('.', '_')}.scenarios")
    return await getattr(scenarios, scenario)(bench)


async def test_one_bad_end_is_forgiven(ros: RosEnvironment, scene: Scene) -> None:
    async def one(number: int, exercise: str, scenario: str) -> None:
        folder = scene.folder / str(number)
        folder.mkdir()
        seen = await ends(ros, folder, exercise, scenario, (1,), SPIN_ON if scenario == "quiet" else CRASH)
        verdict = judge_ending(seen.trace, seen.ending)
        assert verdict.passed, (exercise, scenario, verdict)
        assert (folder / "ends").read_text() == "...", (exercise, scenario)  # the crash, and two more

    async with asyncio.TaskGroup() as together:
        for number, (exercise, scenario) in enumerate(SCENARIOS):
            together.create_task(one(number, exercise, scenario))


@pytest.mark.parametrize(("crashes", "starts"), [((1, 2), 2), ((1, 3), 3)])
async def test_a_second_crash_is_not(scene: Scene, crashes: tuple[int, ...], starts: int) -> None:
    seen = await ends(scene.ros, scene.folder, "i1.3", "call_each_service", crashes, CRASH)
    verdict = judge_ending(seen.trace, seen.ending)
    assert verdict.cause is not None
    assert "signal 11, at calculator_server.py, line" in str(verdict.cause), verdict
    assert len((scene.folder / "ends").read_text()) == starts


async def test_a_second_spin_after_the_end_is_not(scene: Scene) -> None:
    seen = await ends(scene.ros, scene.folder, "i1.3", "call_each_service", (1, 2), SPIN_ON)
    verdict = judge_ending(seen.trace, seen.ending)
    assert "RCLError: failed to initialize wait set" in str(verdict.cause), verdict
    assert (scene.folder / "ends").read_text() == ".."


async def test_what_a_race_in_rclpy_hid_is_seen(scene: Scene) -> None:
    seen = await ends(scene.ros, scene.folder, "i1.3", "call_each_service", (1,), RACE, "raise SystemExit(3)")
    verdict = judge_ending(seen.trace, seen.ending)
    assert "exit code 3" in str(verdict.cause), verdict
    assert (scene.folder / "ends").read_text() == "..."


async def test_a_race_in_rclpy_each_time_is_forgiven(scene: Scene) -> None:
    seen = await ends(scene.ros, scene.folder, "i1.3", "call_each_service", (1, 2), RACE)
    assert judge_ending(seen.trace, seen.ending).passed
    assert (scene.folder / "ends").read_text() == ".."


async def test_a_program_that_does_not_crash_is_started_once(scene: Scene) -> None:
    seen = await ends(scene.ros, scene.folder, "i1.3", "call_each_service", (), CRASH)
    assert judge_ending(seen.trace, seen.ending).passed
    assert (scene.folder / "ends").read_text() == "."
