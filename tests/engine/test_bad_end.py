"""A crash at exit may be chance, so the program is restarted: one crash is forgiven, a repeated one fails."""

from __future__ import annotations

import asyncio
import importlib
from pathlib import Path
from typing import Any

import pytest

from tests.engine.helpers import Scene, refuse_facts
from tutor.content import load_course
from tutor.judge.ending import judge_ending
from tutor.judge.submission import Submission
from tutor.ros.environment import RosEnvironment
from tutor.workspace import solution

# Appended to a solution, to crash as rclpy's C++ code may after shutdown. `{}`: the runs (from 1) that crash, the code
# that these runs execute, and the code that every run executes at its very end.
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
# By chance it raises, as `try_shutdown` above does, and the code appended to the file would not run.
TRIES = "rclpy.try_shutdown()"
TRIES_SAFELY = "with __import__('contextlib').suppress(RuntimeError): rclpy.try_shutdown()"
SCENARIOS = [
    ("i1.1", "plain_start"),
    ("i1.2", "fast"),
    ("i1.3", "call_each_service"),
    ("i2.1", "plain_start"),
    ("i2.3", "run_idle"),
    ("i2.3", "interrupt_during_call"),
]


async def run_scenario(
    ros: RosEnvironment,
    folder: Path,
    exercise: str,
    scenario: str,
    runs: tuple[int, ...],
    code: str,
    always: str = "",
) -> Any:
    """Return a scenario's facts about the exercise's solution, which runs `code` at the end of these runs (from 1)."""
    from tutor.engine.bench import RosBench

    files = {}
    for name, path in solution(load_course().find(exercise)).files.items():
        files[name] = folder / name
        text = path.read_text()
        assert text.count(TRIES) == 1, path
        files[name].write_text(text.replace(TRIES, TRIES_SAFELY) + CRASHES.format(runs, code, always))
    bench = RosBench(Submission(exercise, files), ros, refuse_facts, lambda fraction, text: None)
    scenarios = importlib.import_module(f"checks.{exercise.replace('.', '_')}.scenarios")
    return await getattr(scenarios, scenario)(bench)


async def test_a_single_crash_is_forgiven(ros: RosEnvironment, scene: Scene) -> None:
    async def check_one(number: int, exercise: str, scenario: str) -> None:
        folder = scene.folder / str(number)
        folder.mkdir()
        facts = await run_scenario(ros, folder, exercise, scenario, (1,), SPIN_ON if scenario == "quiet" else CRASH)
        verdict = judge_ending(facts.trace, facts.ending)
        assert verdict.passed, (exercise, scenario, verdict)
        assert (folder / "ends").read_text() == "...", (exercise, scenario)  # the crash, and two more runs

    async with asyncio.TaskGroup() as group:
        for number, (exercise, scenario) in enumerate(SCENARIOS):
            group.create_task(check_one(number, exercise, scenario))


@pytest.mark.parametrize(("crashes", "starts"), [((1, 2), 2), ((1, 3), 3)])
async def test_a_second_crash_fails(scene: Scene, crashes: tuple[int, ...], starts: int) -> None:
    facts = await run_scenario(scene.ros, scene.folder, "i1.3", "call_each_service", crashes, CRASH)
    verdict = judge_ending(facts.trace, facts.ending)
    assert verdict.cause is not None
    assert "signal 11, at calculator_server.py, line" in str(verdict.cause), verdict
    assert len((scene.folder / "ends").read_text()) == starts


async def test_a_second_spin_after_shutdown_fails(scene: Scene) -> None:
    facts = await run_scenario(scene.ros, scene.folder, "i1.3", "call_each_service", (1, 2), SPIN_ON)
    verdict = judge_ending(facts.trace, facts.ending)
    assert "RCLError: failed to initialize wait set" in str(verdict.cause), verdict
    assert (scene.folder / "ends").read_text() == ".."


async def test_an_exit_code_hidden_by_an_rclpy_race_is_found_on_a_further_run(scene: Scene) -> None:
    facts = await run_scenario(scene.ros, scene.folder, "i1.3", "call_each_service", (1,), RACE, "raise SystemExit(3)")
    verdict = judge_ending(facts.trace, facts.ending)
    assert "exit code 3" in str(verdict.cause), verdict
    assert (scene.folder / "ends").read_text() == "..."


async def test_an_rclpy_race_is_forgiven_even_on_every_run(scene: Scene) -> None:
    facts = await run_scenario(scene.ros, scene.folder, "i1.3", "call_each_service", (1, 2), RACE)
    assert judge_ending(facts.trace, facts.ending).passed
    assert (scene.folder / "ends").read_text() == ".."


async def test_a_program_that_does_not_crash_is_started_once(scene: Scene) -> None:
    facts = await run_scenario(scene.ros, scene.folder, "i1.3", "call_each_service", (), CRASH)
    assert judge_ending(facts.trace, facts.ending).passed
    assert (scene.folder / "ends").read_text() == "."
